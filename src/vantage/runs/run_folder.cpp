#include "vantage/runs/run_folder.hpp"

#include <fmt/format.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/options/options.hpp"
#include "vantage/runs/run_document.hpp"
#include "vantage/runs/run_log.hpp"

namespace vantage {

namespace {

constexpr double finest_depth_unit = 1e-4;  // metres
constexpr int no_return = 65535;

/// A depth unit with which the camera's far limit fits into 16 bits.
DepthEncoding encoding_for(const RangeCamera& camera) {
  const double coarsest = std::max(finest_depth_unit, camera.max_depth / (no_return - 1));
  return {.metres_per_unit = std::ceil(coarsest / finest_depth_unit - 1e-9) * finest_depth_unit,
          .no_return = no_return};
}

OutputNames output_names(const std::string& command) {
  return {.command = command,
          .files = {"map.nrrd", "map.ply", "model.ply", "mesh.ply", "config.yaml", "views.csv", "timings.json",
                    "summary.json", "report.html", std::string(RunLog::file_name), "scans/camera-intrinsics.txt",
                    "scans/scans.yaml"},
          .patterns = {"scans/scan-*.depth.png", "scans/scan-*.pose.txt"}};
}

std::string intrinsics_text(const RangeCamera& camera) {
  const double fx = camera.resolution.columns / (camera.right - camera.left);
  const double fy = camera.resolution.rows / (camera.bottom - camera.top);
  return fmt::format("{} 0 {}\n0 {} {}\n0 0 1\n", fx, -0.5 - camera.left * fx, fy, -0.5 - camera.top * fy);
}

/// A frame as `vantage plan` reads it, with what it needs to know about all frames beside it.
void write_frame(const std::filesystem::path& folder, const ScanRecord& record, const RangeImage& image) {
  const DepthEncoding encoding = encoding_for(image.camera);
  const std::string name = scan_file_name(record.scan);
  write_depth_png(folder / (name + ".depth.png"), image, encoding);
  write_pose(folder / (name + ".pose.txt"), record.registered.world_from_sensor);
  if (record.scan > 0) return;
  write_file_atomically(folder / "camera-intrinsics.txt", intrinsics_text(image.camera));
  write_file_atomically(folder / "scans.yaml",
                        fmt::format("# vantage plan THIS_FOLDER --config THIS_FILE\n{}depth-scale: {}\nno-return: {}\n"
                                    "depth-range: [{}, {}]\n",
                                    configuration_head(), encoding.metres_per_unit, no_return, image.camera.min_depth,
                                    image.camera.max_depth));
}

/// The poses of the frames as they are known in the end.
void write_poses(const std::filesystem::path& folder, const std::vector<ScanRecord>& scans) {
  for (const ScanRecord& scan : scans) {
    const std::filesystem::path file = folder / fmt::format("scan-{:03}.pose.txt", scan.scan);
    if (std::filesystem::exists(file)) write_pose(file, scan.registered.world_from_sensor);
  }
}

}  // namespace

std::string scan_file_name(int scan) { return fmt::format("scan-{:03}", scan); }

PointCloud object_cloud(const ObjectModel& model) {
  const PointCloud& all = model.surface.cloud();
  PointCloud inside;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (model.map.enclosure().contains(model.map.grid().index_of(all.points[i]))) {
      inside.add(all.points[i], all.normals[i]);
    }
  }
  return inside;
}

RunFolder::RunFolder(const std::filesystem::path& path, RunDescription description, ForeignFiles foreign)
    : folder_(path, output_names(description.command), foreign), description_(std::move(description)) {
  create_folders(path / "scans");
  data_.command = description_.command;
  data_.object = description_.object;
  data_.program = description_.program;
  data_.options = description_.options;
  data_.camera = description_.camera;
  data_.candidates = description_.candidates;
  data_.candidates_text = description_.candidates_text;
  data_.seed = description_.seed;
  data_.simulated = description_.truth.has_value();
  if (description_.truth) data_.truth = *description_.truth;
  data_.state = RunData::State::running;
}

void RunFolder::set_candidates(Candidates candidates, std::string text) {
  data_.candidates = description_.candidates = std::move(candidates);
  data_.candidates_text = description_.candidates_text = std::move(text);
}

void RunFolder::add_scan(const ScanRecord& record, const Scan& scan, const ObjectModel& model, const Plan* plan) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) write_frame(path() / "scans", record, image->image);
  data_.grid = model.map.grid();
  data_.enclosure = model.map.enclosure();
  if (description_.surface && model.kept.contains(record.scan)) {
    if (!kept_in_) kept_in_ = std::make_shared<ScratchFile>();
    kept_.insert_or_assign(record.scan, KeptScan(scan, kept_in_));
  } else {
    add_to_surface(record, scan, model.map);
  }
  if (on_event && data_.scans.empty()) on_event("run", run_json(data_));
  data_.add_scan(record, model, plan);
  if (on_event) on_event("scan", scan_json(data_.scans.back()));
}

void RunFolder::add_plan(const Plan& plan) {
  if (on_event) on_event("plan", plan_json(candidate_plan(plan, description_.candidates.views.size())));
}

void RunFolder::add_to_surface(const ScanRecord& record, const Scan& scan, const VoxelMap& map) {
  if (!description_.surface || !record.merged) return;
  if (!surface_) surface_.emplace(map.grid().box(map.enclosure()), *description_.surface);
  surface_->fuse(scan, record.registered, description_.sensor, record.residual);
}

void RunFolder::make_surface_again(const ObjectModel& model) {
  if (!description_.surface || kept_.empty()) return;
  surface_.reset();
  for (const auto& [number, scan] : kept_) {
    add_to_surface(model.scans[static_cast<std::size_t>(number)], scan.scan(), model.map);
  }
}

std::optional<MeshQuality> RunFolder::write_surface(const VoxelMap& map) {
  if (!surface_) return std::nullopt;
  const MeasuredMesh mesh = surface_->mesh(map);
  if (mesh.empty()) return std::nullopt;
  write_measured_mesh_ply(path() / "mesh.ply", mesh);
  data_.mesh = mesh.mesh;
  return quality_of(mesh, surface_->options().target_accuracy);
}

void RunFolder::finish(const ObjectModel& model, const RunSummary& summary, const std::optional<Plan>& next,
                       double total_seconds, const RunPage& page) {
  write_map(model.map, path() / "map.nrrd");
  write_cloud_ply(path() / "model.ply", object_cloud(model));
  write_file_atomically(path() / "config.yaml", description_.config);
  write_file_atomically(path() / "views.csv", views_csv(model.scans));
  write_poses(path() / "scans", model.scans);
  write_file_atomically(path() / "timings.json", timings_json(model.scans, total_seconds).dump(2) + "\n");
  RunSummary whole = summary;
  make_surface_again(model);
  whole.mesh = write_surface(model.map);
  write_file_atomically(path() / "summary.json", summary_json(model, whole).dump(2) + "\n");
  if (!page && !on_event) return;
  data_.finish(model, summary.stop_reason);
  if (next) data_.next = candidate_plan(*next, description_.candidates.views.size());
  if (page) write_file_atomically(path() / "report.html", page(data_, model.map, total_seconds));
  if (!on_event) return;
  if (data_.next) on_event("plan", plan_json(*data_.next));
  on_event("result", result_json(data_));
  on_event("state", state_json(data_));
}

}  // namespace vantage
