#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli_options.hpp"
#include "clock.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "notes.hpp"
#include "plan_table.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/model/scan_model.hpp"
#include "vantage/model/unposed.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/options/scan_planning_options.hpp"
#include "vantage/report/static_report.hpp"
#include "vantage/runs/ranked_views.hpp"
#include "vantage/runs/run_folder.hpp"

namespace vantage::app {
namespace {

struct PlanRequest {
  std::string scans;
  std::string out;
  int top = 10;
  bool overwrite = false;
  bool report = true;
  bool conclude = false;
  ScanPlanningOptions options;
  SurfaceOptions surface;
  std::set<std::string> given;  // names of options that the user set
  ProgramOptions program;
};

RunDescription describe_run(PlanRequest& request, const RangeCamera& camera) {
  RunDescription description;
  description.command = "plan";
  description.object = std::filesystem::path(name_of_folder(request.scans)).stem().string();
  description.program = VANTAGE_VERSION;
  std::vector<OptionField> fields = option_fields(request.options);
  append_changed(fields, request.surface);
  for (const OptionField& field : fields) description.options.emplace_back(field.name, field.text());
  description.config = "# vantage plan " + request.scans + "\n" + configuration_head() + options_as_yaml(fields);
  description.camera = camera;
  if (request.report) description.surface = request.surface;
  return description;
}

/// What an earlier run left in the output folder is removed, and these scans may be of one.
void require_apart(const std::filesystem::path& scans, const std::filesystem::path& out) {
  const std::filesystem::path read = std::filesystem::weakly_canonical(scans);
  for (const char* below : {"", "scans"}) {
    const std::filesystem::path written = std::filesystem::weakly_canonical(out / below);
    require(read != written && read.parent_path() != written, "out = ", out.string(),
            ": holds the scans that are read, ", scans.string(), "; choose another folder");
  }
}

void plan(PlanRequest& request) {
  const auto start = Clock::now();
  const auto threads = limit_threads(request.program.threads);
  require(request.top >= 0, "top = ", request.top, ": must not be negative");
  print_hints(load_robot(request.options.planning, request.given));
  request.options.validate_without_commands();
  request.surface.validate();
  const ScanSet set = open_scans(request.scans, request.options.reading);
  if (!request.program.quiet) print_scan_set(set);
  std::vector<PendingScan> pending;
  for (const ScanFile& file : set.scans) pending.push_back({file.name, file.view, file.read});
  if (!request.options.reading.has_poses()) {
    FoundScans found = with_found_poses(pending, request.options.scene);
    if (!request.program.quiet) {
      for (const std::string& note : found.notes) print_note("{}\n", note);
    }
    pending = std::move(found.scans);
  }
  pending = kept_for_second_reading(std::move(pending));
  ScanScene fitted = fit_scene(pending, request.options.scene);
  request.options.require_can_plan(fitted.scene);
  const RunDescription description = describe_run(request, request.options.camera(set.camera));
  std::optional<RunFolder> folder;
  if (!request.out.empty()) {
    require_apart(request.scans, request.out);
    folder.emplace(request.out, description, request.overwrite ? ForeignFiles::overwrite : ForeignFiles::refuse);
  }

  const std::unique_ptr<Registrar> registrar = make_registrar(request.options.scene, fitted);
  ScanModel scans(fitted);
  catch_interrupts();
  for (const PendingScan& each : pending) {
    if (was_interrupted())
      throw Error(fmt::format("interrupted after {} of {} scans; nothing was planned", scans.model().scans.size(),
                              pending.size()));
    const Scan scan = each.read();
    const ScanRecord& record = scans.add({.name = each.name}, scan, each.believed, *registrar);
    if (!request.program.quiet) print_note("{}", record_line(record));
    if (folder) folder->add_scan(record, scan, scans.model(), nullptr);
  }

  if (!request.options.scene.radius) fitted.radius = scans.sensor_distance();
  Planner planner = request.options.planner(fitted.candidates(request.options.scene.views), set.camera);
  if (folder) {
    folder->set_candidates(planner.candidates(),
                           fmt::format("sphere:{}:{:.3f}", request.options.scene.views, fitted.radius));
  }
  if (!request.program.quiet) {
    print_note("sensor, {}: standard deviation {}\n", scans.sensor_is_given() ? "as given" : "estimated",
               vantage::description(scans.model().sensor));
  }
  tell_of_scans(planner, scans.model().scans);
  const std::optional<Plan> next = planner.next_best_view(scans.model().map, scans.current());
  // What is planned is the same with and without a folder; only what is written there is concluded.
  const std::vector<ScanRecord> planned_on = scans.model().scans;
  RunSummary summary;
  summary.object = description.object;
  summary.stop_reason = next ? "" : planner.why_finished();
  if (folder) {
    const std::vector<int> came_in = request.conclude ? scans.conclude(*registrar) : std::vector<int>();
    for (const int number : came_in) {
      if (!request.program.quiet)
        print_note("scan {} came in at the end, {}\n", number,
                   printable(pending[static_cast<std::size_t>(number)].name));
    }
    folder->finish(scans.model(), summary, next, seconds_since(start),
                   request.report ? RunPage(report_page) : RunPage());
  }
  if (request.program.json) {
    fmt::print("{}\n", ranked_views_json(next, planner.why_finished(), planned_on, request.top).dump(2));
  } else {
    print_plan(next, planner.why_finished(), {request.top, request.program.verbose});
    if (folder) fmt::print("written to {}\n", folder->path().string());
  }
}

}  // namespace

void add_plan(CLI::App& program) {
  auto request = std::make_shared<PlanRequest>();
  CLI::App* command = program.add_subcommand("plan", "Take real scans and say where to look next, with the reasons");
  command
      ->add_option("scans", request->scans,
                   "folder of depth frames or clouds with poses, a ROS bag, or a Stanford .conf")
      ->required();
  command->add_option("--out", request->out,
                      "folder for the model, the map and the report; nothing is written without");
  command->add_flag("--overwrite", request->overwrite,
                    "write into --out although it holds other files, and replace those of the same names");
  command->add_option("--top", request->top, "views to print, best first")->capture_default_str();
  command->add_flag("--conclude", request->conclude,
                    "no scan follows: before --out is written, try refused scans again and improve all poses together");
  command->add_flag("--report,!--no-report", request->report, "write mesh.ply and report.html");
  add_options(*command, noting(with_fields(option_fields(request->options), request->surface), request->given));
  add_program_options(*command, request->program);
  command->callback([request] { plan(*request); });
}

}  // namespace vantage::app
