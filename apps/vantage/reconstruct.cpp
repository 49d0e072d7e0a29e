#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "cli_options.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "object_source.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/io/run_folder.hpp"
#include "vantage/reconstruction/simulate.hpp"

namespace vantage::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Request {
  std::string object;
  std::string out;
  bool report = true;
  ReconstructOptions options;
  ProgramOptions program;
};

void print_progress(const ScanRecord& record) {
  fmt::print(
      stderr,
      "scan {:>2}  view {:>4}  {:>6.2f} % of the visible surface  {:>5} new voxels  {:>6.2f} m  {:>4.0f} ms  {}\n",
      record.scan + 1, record.candidate, 100 * record.coverage.value_or(0), record.new_occupied, record.distance,
      1000 * record.timings.total(), record.merged ? record.reason : "NOT MERGED: " + record.verdict);
}

RunDescription describe_run(const Request& request, const std::string& object_name, const SimulatedObject& object) {
  RunDescription description;
  description.command = "reconstruct";
  description.object = object_name;
  description.program = VANTAGE_VERSION;
  ReconstructOptions options = request.options;
  const std::vector<OptionField> fields = option_fields(options);
  for (const OptionField& field : fields) description.options.emplace_back(field.name, field.text());
  description.config =
      fmt::format("# vantage reconstruct {} --config THIS_FILE\n{}", object_name, options_as_yaml(fields));
  description.camera = request.options.range_camera();
  description.candidates = request.options.candidate_views();
  description.candidates_text = request.options.candidates;
  description.truth = object.scanner().mesh();
  return description;
}

RunSummary summarise(const Request& request, const std::string& object_name, const SimulatedObject& object,
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

void reconstruct(const Request& request) {
  const auto start = Clock::now();
  const auto threads = limit_threads(request.program.threads);
  request.options.validate();
  const ObjectSource source = find_object(request.object);
  const SimulatedObject object(source.mesh, request.options.size.value_or(source.default_size), request.options);
  RunFolder folder(
      request.out.empty() ? std::filesystem::path("runs") / source.name : std::filesystem::path(request.out),
      describe_run(request, source.name, object));

  catch_interrupts();
  RunObserver observer;
  observer.interrupted = was_interrupted;
  observer.on_scan = [&](const ScanRecord& record, const Scan& scan, const ObjectModel& model, const Plan* plan) {
    folder.add_scan(record, scan, model, plan);
    if (!request.program.quiet) print_progress(record);
  };
  const SimulatedRun run = simulate(object, request.options, observer);

  const RunSummary summary = summarise(request, source.name, object, run);
  folder.finish(run.model, summary, std::nullopt, seconds_since(start),
                request.report ? RunPictures::mesh_and_report : RunPictures::none);
  if (request.program.json) {
    fmt::print("{}\n", summary_json(run.model, summary).dump(2));
    return;
  }
  const ScanRecord& last = run.model.scans.back();
  fmt::print(
      "{}: {} scans, {:.2f} % of the visible surface, {} occupied voxels, quality {:.3f}, {:.2f} m travelled, {:.2f} "
      "s\n",
      source.name, run.model.scans.size(), 100 * last.coverage.value_or(0), last.labels.occupied, last.mean_quality,
      last.distance, seconds_since(start));
  fmt::print("{}: {}\n", run.stop_reason == "interrupted" ? "kept what was scanned" : "finished", run.stop_reason);
  fmt::print("written to {}{}\n", folder.path().string(), request.report ? "; open report.html there" : "");
}

}  // namespace

void add_reconstruct(CLI::App& program) {
  auto request = std::make_shared<Request>();
  CLI::App* command =
      program.add_subcommand("reconstruct", "Simulate the whole loop: scan an object with planned views");
  command->add_option("object", request->object, "a built-in object (see `vantage objects`) or the path of a mesh")
      ->required();
  command->add_option("--out", request->out, "output folder; runs/OBJECT by default");
  command->add_flag("--report,!--no-report", request->report, "write mesh.ply and report.html");
  add_options(*command, request->options);
  add_program_options(*command, request->program);
  command->callback([request] { reconstruct(*request); });
}

}  // namespace vantage::app
