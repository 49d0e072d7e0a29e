#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "cli_options.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "plan_table.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/io/run_folder.hpp"
#include "vantage/io/scan_folder.hpp"
#include "vantage/reconstruction/from_scans.hpp"

namespace vantage::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Request {
  std::string scans;
  std::string out;
  int top = 10;
  bool report = true;
  ScanPlanOptions plan;
  ScanFolderOptions folder;
  ReconstructOptions planner;  // camera (where the scans bring none), utility, search and reach
  ProgramOptions program;
};

std::vector<OptionField> fields_of(Request& request) {
  std::vector<OptionField> fields = option_fields(request.plan);
  for (OptionField& field : option_fields(request.folder)) fields.push_back(std::move(field));
  for (OptionField& field : fields_named(option_fields(request.planner), planning_option_names())) {
    // The depth range is that of the scans, and the candidates are a sphere around the box.
    if (field.name != "depth-range" && field.name != "candidates") fields.push_back(std::move(field));
  }
  return fields;
}

void print_progress(const ScanRecord& record, const std::string& name) {
  fmt::print(
      stderr,
      "{:<24} {:<20} overlap {:>5.1f} %  residual {:>6.2f} mm  moved {:>5.1f} mm {:>4.1f} deg  {:>5} new voxels{}\n",
      name, record.verdict, 100 * record.overlap, 1000 * record.residual,
      1000 * (record.registered.position() - record.believed.position()).norm(),
      degrees(rotation_angle(record.registered.world_from_sensor.linear(), record.believed.world_from_sensor.linear())),
      record.new_occupied, record.merged ? "" : "  NOT MERGED");
}

RangeCamera camera_for(const Request& request, const ScanSet& set) {
  RangeCamera camera = set.camera.value_or(request.planner.range_camera());
  camera.min_depth = request.folder.depth_range[0];
  camera.max_depth = request.folder.depth_range[1];
  camera.validate();
  return camera;
}

std::unique_ptr<Registrar> make_registrar(const ScanPlanOptions& options, const ScanScene& fitted) {
  if (options.registration == "none") return std::make_unique<TrustingRegistrar>();
  RegistrationOptions registration;
  // Real frames are noisy: surfels of two voxels average that out. And a robot's poses are good: what the surfaces
  // leave open stays as the robot says.
  registration.search_radius = options.pose_error;
  registration.orientation_error = radians(options.pose_angle_error) / 3;
  registration.spacing = fitted.scene.voxel_length;
  registration.finest_cell_in_spacings = 2;
  registration.trust = 0.01;
  registration.largest_open_misfit = options.pose_error;
  registration.largest_share_in_free_space = 0.2;
  return std::make_unique<IcpRegistrar>(registration, fitted.region);
}

void plan(Request& request) {
  const auto start = Clock::now();
  const auto threads = limit_threads(request.program.threads);
  require(request.top >= 0, "top = ", request.top, ": must not be negative");
  const ScanSet set = open_scans(request.scans, request.folder);
  std::vector<PendingScan> pending;
  for (const ScanFile& file : set.scans) pending.push_back({file.name, file.view, file.read});
  const ScanScene fitted = fit_scene(pending, request.plan);
  const Candidates candidates = fitted.candidates(request.plan.views);
  Planner planner(candidates, camera_for(request, set), request.planner.planner_options());

  RunDescription description;
  description.command = "plan";
  description.object = std::filesystem::path(request.scans).lexically_normal().stem().string();
  description.program = VANTAGE_VERSION;
  for (const OptionField& field : fields_of(request)) description.options.emplace_back(field.name, field.text());
  description.config = "# vantage plan " + request.scans + "\n" + options_as_yaml(fields_of(request));
  description.camera = planner.camera();
  description.candidates = candidates;
  description.candidates_text = fmt::format("sphere:{}:{:.3f}", request.plan.views, fitted.radius);
  std::optional<RunFolder> folder;
  if (!request.out.empty()) folder.emplace(request.out, description);

  const std::unique_ptr<Registrar> registrar = make_registrar(request.plan, fitted);
  ObjectModel model(fitted.scene, fitted.scene.voxel_length / 4);
  View current;
  catch_interrupts();
  for (const PendingScan& each : pending) {
    if (was_interrupted()) break;
    const Scan scan = each.read();
    ScanRecord record = update(model, scan, each.believed, *registrar);
    record.commanded = each.believed;
    record.reason = each.name;
    const Vec3 position = sensor_position(scan, record.registered);
    record.distance = model.scans.empty() ? 0 : model.scans.back().distance + (position - current.position()).norm();
    current = record.registered;
    current.world_from_sensor.translation() = position;
    if (!request.program.quiet) print_progress(record, each.name);
    if (folder) folder->add_scan(record, scan, model, nullptr);
    model.scans.push_back(std::move(record));
  }

  const std::optional<Plan> next = planner.next_best_view(model.map, current);
  RunSummary summary;
  summary.object = description.object;
  summary.stop_reason = next ? "" : planner.why_finished();
  if (folder) {
    folder->finish(model, summary, next, seconds_since(start),
                   request.report ? RunPictures::mesh_and_report : RunPictures::none);
  }
  if (request.program.json) {
    fmt::print("{}\n", plan_json(next, planner.why_finished(), model, request.top).dump(2));
  } else {
    print_plan(next, planner.why_finished(), request.top);
    if (folder) fmt::print("written to {}\n", folder->path().string());
  }
}

}  // namespace

void add_plan(CLI::App& program) {
  auto request = std::make_shared<Request>();
  CLI::App* command = program.add_subcommand("plan", "Take real scans and say where to look next, with the reasons");
  command->add_option("scans", request->scans, "folder of depth frames or clouds with poses, or a Stanford .conf")
      ->required();
  command->add_option("--out", request->out,
                      "folder for the model, the map and the report; nothing is written without");
  command->add_option("--top", request->top, "views to print, best first")->capture_default_str();
  command->add_flag("--report,!--no-report", request->report, "write mesh.ply and report.html");
  add_options(*command, fields_of(*request));
  add_program_options(*command, request->program);
  command->callback([request] { plan(*request); });
}

}  // namespace vantage::app
