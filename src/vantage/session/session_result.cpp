#include <fmt/format.h>

#include <chrono>

#include "vantage/core/error.hpp"
#include "vantage/runs/run_folder.hpp"
#include "vantage/session/session.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

RunDescription describe_run(const Session& session, const SessionState& state, const Planner& planner) {
  ScanPlanningOptions options = session.options();
  const std::vector<OptionField> fields = option_fields(options);
  RunDescription description;
  description.command = "session";
  description.object = name_of_folder(session.folder());
  description.program = VANTAGE_VERSION;
  for (const OptionField& field : fields) description.options.emplace_back(field.name, field.text());
  description.config =
      "# vantage session new ANOTHER_FOLDER --config THIS_FILE\n" + configuration_head() + options_as_yaml(fields);
  description.camera = planner.camera();
  description.candidates = planner.candidates();
  description.candidates_text = fmt::format("sphere:{}:{:.3f}", options.scene.views, state.radius);
  description.surface = SurfaceOptions{};
  return description;
}

}  // namespace

void Session::finish(const RunPage& page, ForeignFiles foreign, Ending ending) {
  const std::lock_guard finishing(finishing_);
  const auto start = Clock::now();
  const SessionPlan last = next();
  const SessionState& state = *last.state;
  require(!state.scans.empty(), folder().string(), ": ", last.why_finished);
  RunFolder run(folder(), describe_run(*this, state, session_planner(options(), state, {})), foreign);
  // The scans once more from the disk, so that others may be added meanwhile; the report shows the map after each.
  SessionModel model(options());
  for (const int number : state.numbers) {
    const SessionScan scan = folder_.read(number);
    (void)model.add(number, scan, folder_.located(number));
    run.add_scan(model.model().scans.back(), scan.scan, model.model(), nullptr);
  }
  if (ending == Ending::concluded) model.conclude();
  RunSummary summary;
  summary.object = name_of_folder(folder());
  summary.stop_reason = last.why_finished;
  run.finish(model.model(), summary, last.plan, std::chrono::duration<double>(Clock::now() - start).count(), page);
}

}  // namespace vantage
