#include "vantage/io/stored_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/io/atomic_file.hpp"
#include "vantage/io/map_file.hpp"
#include "vantage/io/mesh_file.hpp"
#include "vantage/io/point_cloud_file.hpp"
#include "vantage/io/run_scene.hpp"
#include "vantage/io/stored_run_files.hpp"
#include "vantage/reconstruction/options.hpp"

namespace vantage {
namespace {

bool says_that_it_failed(const std::string& verdict) {
  constexpr std::array failures{Verdict::insufficient_overlap, Verdict::not_converged, Verdict::large_residual,
                                Verdict::degenerate, Verdict::ambiguous};
  return std::any_of(failures.begin(), failures.end(), [&](Verdict failure) { return verdict == name(failure); });
}

}  // namespace

StoredRun read_stored_run(const std::filesystem::path& folder) {
  require(std::filesystem::is_directory(folder), folder.string(), ": is no folder; it must be the output of a run");
  const auto has = [&](const char* file) { return std::filesystem::exists(folder / file); };
  require(has("map.nrrd") || has("model.ply") || has("mesh.ply"), folder.string(),
          ": has neither map.nrrd nor model.ply nor mesh.ply; it must be the output of a run");
  StoredRun run;
  run.object = std::filesystem::absolute(folder).lexically_normal().filename().string();
  if (has("map.nrrd")) run.map = read_map(folder / "map.nrrd");
  if (has("model.ply")) run.cloud = read_cloud(folder / "model.ply").cloud;
  if (has("mesh.ply")) run.mesh = read_mesh(folder / "mesh.ply");
  if (has("summary.json")) {
    const std::filesystem::path file = folder / "summary.json";
    StoredSummary summary = parse_run_summary(read_file(file), file.string());
    run.object = summary.object.value_or(run.object);
    run.scans = std::move(summary.scans);
    for (ScanRecord& scan : run.scans) scan.merged = !says_that_it_failed(scan.verdict);
  }
  if (has("config.yaml")) {
    const std::filesystem::path file = folder / "config.yaml";
    const StoredConfig config = parse_run_config(read_file(file), file.string());
    const Vec3 center = run.map ? run.map->enclosure_center() : Vec3(Vec3::Zero());
    try {
      if (config.camera) run.camera = camera_from_text(*config.camera);
      if (config.candidates) run.candidates = candidates_from_text(*config.candidates, center);
    } catch (const InputError& error) {
      throw InputError(concat(file.string(), ": ", error.what()));
    }
  }
  return run;
}

ReportData StoredRun::report_data() const {
  ReportData data;
  data.object = object;
  data.camera = camera;
  data.candidates = candidates;
  data.scans = scans;
  data.map = map ? &*map : nullptr;
  data.cloud = &cloud;
  data.mesh = &mesh;
  return data;
}

std::vector<std::string> run_picture_subjects() { return {"views", "model", "quality", "normals", "labels"}; }

void RunPicture::validate() const {
  const std::vector<std::string> subjects = run_picture_subjects();
  std::string names;
  for (const std::string& subject : subjects) names += (names.empty() ? "" : ", ") + subject;
  require(std::find(subjects.begin(), subjects.end(), show) != subjects.end(), "show = '", show, "': must be one of ",
          names);
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.validate();
  require(std::isfinite(turn) && std::isfinite(rise), "turn = ", turn, ", rise = ", rise, ": must be finite");
  require(std::abs(rise) <= 90, "rise = ", rise, " degrees: must be -90 to 90");
}

Picture draw(const StoredRun& run, const RunPicture& picture) {
  picture.validate();
  const ReportData data = run.report_data();
  PictureScene scene;
  if (picture.show == "views" || picture.show == "model") {
    scene = picture.show == "views" ? views_scene(data) : model_scene(data);
  } else {
    require(run.map.has_value(), "show = '", picture.show, "': the run has no map.nrrd");
    const VoxelMap& map = *run.map;
    add_voxels(scene, map,
               picture.show == "quality"   ? paint_quality(map)
               : picture.show == "normals" ? paint_normals(map)
                                           : paint_labels(map));
  }
  require(!scene.box().isEmpty(), "show = '", picture.show, "': the run has nothing of it to show");
  RenderOptions options;
  options.width = picture.width;
  options.height = picture.height;
  if (picture.show != "views") options.floor = floor_under(scene, picture.up);
  const double shape = static_cast<double>(picture.width) / picture.height;
  return render(scene, camera_around(scene, side_of(picture.up, picture.turn, picture.rise), shape, picture.up),
                options);
}

}  // namespace vantage
