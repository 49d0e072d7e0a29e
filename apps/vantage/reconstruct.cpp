#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli_options.hpp"
#include "clock.hpp"
#include "commands.hpp"
#include "cost_note.hpp"
#include "interrupt.hpp"
#include "notes.hpp"
#include "object_source.hpp"
#include "page_server.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/report/static_report.hpp"
#include "vantage/runs/run_folder.hpp"
#include "vantage/runs/run_log.hpp"
#include "vantage/simulation/simulate.hpp"

namespace vantage::app {
namespace {

struct ReconstructRequest {
  std::string object;
  std::string out;
  bool overwrite = false;
  bool report = true;
  std::string serve;  // the port; empty: not served
  PageServerOptions server;
  ReconstructOptions options;
  SurfaceOptions surface;
  std::set<std::string> given;  // names of options that the user set
  ProgramOptions program;
};

void print_progress(const ScanRecord& record, const std::string& travel_unit) {
  print_note(
      "scan {:>2}  view {:>4}  {:>6.2f} % of the visible surface  {:>5} new voxels  {:>6.2f} {}  {:>4.0f} ms  {}\n",
      record.scan + 1, record.candidate, 100 * record.coverage.value_or(0), record.new_occupied, record.distance,
      travel_unit, 1000 * record.timings.total(),
      record.merged ? record.reason : fmt::format("NOT MERGED, {}: {}", record.verdict, record.detail));
}

RunDescription describe_run(const ReconstructRequest& request, const std::string& object_name,
                            const SimulatedObject& object) {
  RunDescription description;
  description.command = "reconstruct";
  description.object = object_name;
  description.program = VANTAGE_VERSION;
  ReconstructOptions options = request.options;
  SurfaceOptions surface = request.surface;
  std::vector<OptionField> fields = option_fields(options);
  append_changed(fields, surface);
  for (const OptionField& field : fields) description.options.emplace_back(field.name, field.text());
  description.config = fmt::format("# vantage reconstruct {} --config THIS_FILE\n{}{}", object_name,
                                   configuration_head(), options_as_yaml(fields));
  description.camera = request.options.range_camera();
  description.candidates = request.options.candidate_views();
  description.candidates_text = request.options.candidates;
  description.truth = object.scanner().mesh();
  description.seed = request.options.seed;
  if (request.report) description.surface = request.surface;
  description.sensor = request.options.sensor_model();
  return description;
}

RunSummary summarise(const ReconstructRequest& request, const std::string& object_name, const SimulatedObject& object,
                     const SimulatedRun& run) {
  RunSummary summary;
  summary.object = object_name;
  summary.stop_reason = run.stop_reason;
  summary.seed = request.options.seed;
  const PointCloud cloud = object_cloud(run.model);
  const Accuracy accuracy = object.truth().accuracy(cloud);
  const Completeness completeness = object.truth().completeness(cloud);
  summary.accuracy_rms = accuracy.root_mean_square;
  summary.accuracy_95 = accuracy.percentile_95;
  summary.completeness = completeness.visible;
  summary.completeness_all = completeness.all;
  return summary;
}

/// Who else follows the run: the log beside the results, and browsers.
struct Audience {
  std::optional<RunLog> log;
  LiveRun live;
  std::unique_ptr<HttpServer> server;  // after what it shows

  Audience(const ReconstructRequest& request, const std::filesystem::path& folder) {
    if (!request.serve.empty()) {
      PageServerOptions options = request.server;
      options.port = port_from_text(request.serve, "--serve");
      server = page_server(options, live);
      start_and_tell(*server);
    }
    if (request.report) log.emplace(folder);
  }

  /// The run goes on where they cannot be notified.
  void tell(std::string_view event, const nlohmann::ordered_json& data) {
    try {
      if (log) log->add(event, data);
    } catch (const Error& error) {
      print_note("vantage: {}; the run goes on without it\n", error.what());
      log->remove();
      log.reset();
    }
    if (!server) return;
    try {
      if (event == "run")
        live.begin(data);
      else
        live.add(event, data);
    } catch (const std::exception& error) {
      print_note("vantage: the page was not told of an event: {}\n", error.what());
    }
  }
};

void print_result(const ReconstructRequest& request, const RunFolder& folder, const RunSummary& summary,
                  const ObjectModel& model, double seconds) {
  if (request.program.json) {
    fmt::print("{}\n", summary_json(model, summary).dump(2));
    return;
  }
  const ScanRecord& last = model.scans.back();
  fmt::print(
      "{}: {} scans, {:.2f} % of the visible surface, {} occupied voxels, quality {:.3f}, {:.2f} {} travelled, {:.2f} "
      "s\n",
      summary.object, model.scans.size(), 100 * last.coverage.value_or(0), last.labels.occupied, last.mean_quality,
      last.distance, request.options.travel_unit(), seconds);
  fmt::print("{}: {}\n", summary.stop_reason == "interrupted" ? "kept what was scanned" : "finished",
             summary.stop_reason);
  fmt::print("written to {}{}\n", folder.path().string(), request.report ? "; open report.html there" : "");
}

void reconstruct(ReconstructRequest& request) {
  const auto start = Clock::now();
  const auto threads = limit_threads(request.program.threads);
  print_hints(load_robot(request.options, request.given));
  request.options.validate();
  const std::string cost =
      cost_note(request.options.candidate_views().views.size(), request.options.range_camera().resolution);
  if (!cost.empty() && !request.program.quiet) print_note("{}\n", cost);
  request.surface.validate();
  const ObjectSource source = find_object(request.object);
  const SimulatedObject object(source.mesh, request.options.size.value_or(source.default_size), request.options);
  RunFolder folder(
      request.out.empty() ? std::filesystem::path("runs") / source.name : std::filesystem::path(request.out),
      describe_run(request, source.name, object), request.overwrite ? ForeignFiles::overwrite : ForeignFiles::refuse);

  catch_interrupts();
  Audience audience(request, folder.path());
  if (audience.log || audience.server)
    folder.on_event = [&](std::string_view event, const nlohmann::ordered_json& data) { audience.tell(event, data); };
  RunObserver observer;
  observer.on_plan = [&](const Plan& plan) { folder.add_plan(plan); };
  observer.interrupted = was_interrupted;
  observer.on_scan = [&](const ScanRecord& record, const Scan& scan, const ObjectModel& model, const Plan* plan) {
    folder.add_scan(record, scan, model, plan);
    if (!request.program.quiet) print_progress(record, request.options.travel_unit());
  };
  const SimulatedRun run = simulate(object, request.options, observer);

  const RunSummary summary = summarise(request, source.name, object, run);
  folder.finish(run.model, summary, std::nullopt, seconds_since(start),
                request.report ? RunPage(report_page) : RunPage());
  if (audience.log) audience.log->remove();
  print_result(request, folder, summary, run.model, seconds_since(start));
  std::fflush(stdout);
  if (audience.server) wait_for_interrupt();
}

}  // namespace

void add_reconstruct(CLI::App& program) {
  auto request = std::make_shared<ReconstructRequest>();
  CLI::App* command =
      program.add_subcommand("reconstruct", "Simulate the whole loop: scan an object with planned views");
  command->add_option("object", request->object, "a built-in object (see `vantage objects`) or the path of a mesh")
      ->required();
  command->add_option("--out", request->out, "output folder; runs/OBJECT by default");
  command->add_flag("--overwrite", request->overwrite,
                    "write into --out although it holds other files, and replace those of the same names");
  command->add_flag("--report,!--no-report", request->report, "write mesh.ply and report.html");
  // A flag, so that a word after it is not taken for the port.
  command->add_flag("--serve{8350}", request->serve,
                    "show the run in the browser while it goes on, until Ctrl-C; --serve=PORT, 0: any free one");
  add_page_server_options(*command, request->server);
  add_options(*command, noting(with_fields(option_fields(request->options), request->surface), request->given));
  add_program_options(*command, request->program);
  command->callback([request] { reconstruct(*request); });
}

}  // namespace vantage::app
