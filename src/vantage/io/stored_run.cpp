#include "vantage/io/stored_run.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/io/atomic_file.hpp"
#include "vantage/io/json_text.hpp"
#include "vantage/io/map_file.hpp"
#include "vantage/io/mesh_file.hpp"
#include "vantage/io/point_cloud_file.hpp"
#include "vantage/io/run_scene.hpp"
#include "vantage/reconstruction/options.hpp"

namespace vantage {
namespace {

View view_from_json(const nlohmann::json& pose, const std::string& what) {
  require(pose.is_array() && pose.size() == 7, what, ": must be 7 numbers x y z qx qy qz qw");
  std::array<double, 7> n{};
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = json_number(pose[i], what);
  const Eigen::Quaterniond rotation(n[6], n[3], n[4], n[5]);
  require(std::abs(rotation.norm() - 1) < 1e-3, what, ": the quaternion has length ", rotation.norm(), ", must be 1");
  View view;
  view.world_from_sensor.linear() = rotation.normalized().toRotationMatrix();
  view.world_from_sensor.translation() = Vec3(n[0], n[1], n[2]);
  return view;
}

bool says_that_it_failed(const std::string& verdict) {
  constexpr std::array failures{Verdict::insufficient_overlap, Verdict::not_converged, Verdict::large_residual,
                                Verdict::degenerate, Verdict::ambiguous};
  return std::any_of(failures.begin(), failures.end(), [&](Verdict failure) { return verdict == name(failure); });
}

void read_summary(StoredRun& run, const std::filesystem::path& path) {
  const nlohmann::json summary = parse_json(read_file(path), path.string());
  require(summary.is_object(), path.string(), ": must be an object, is ", summary.type_name());
  const nlohmann::json object = summary.value("object", nlohmann::json(run.object));
  require(object.is_string(), path.string(), ", object: must be text, is ", object.type_name());
  run.object = object.get<std::string>();
  const nlohmann::json scans = summary.value("scans", nlohmann::json::array());
  require(scans.is_array(), path.string(), ", scans: must be a list, is ", scans.type_name());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::string what = concat(path.string(), ", scans[", i, "]");
    require(scans[i].is_object(), what, ": must be an object, is ", scans[i].type_name());
    ScanRecord scan;
    scan.scan = static_cast<int>(i);
    const nlohmann::json candidate = scans[i].value("candidate", nlohmann::json());
    if (candidate.is_number_integer()) scan.candidate = candidate.get<int>();
    for (const auto& [key, view] :
         {std::pair{"commanded", &scan.commanded}, {"believed", &scan.believed}, {"registered", &scan.registered}})
      *view = view_from_json(scans[i].value(key, nlohmann::json()), concat(what, ".", key));
    const nlohmann::json verdict = scans[i].value("verdict", nlohmann::json());
    if (verdict.is_string()) scan.verdict = verdict.get<std::string>();
    scan.merged = !says_that_it_failed(scan.verdict);
    run.scans.push_back(scan);
  }
}

void read_config(StoredRun& run, const std::filesystem::path& path) {
  try {
    const YAML::Node config = YAML::Load(read_file(path));
    if (const YAML::Node camera = config["camera"]) run.camera = camera_from_text(camera.as<std::string>());
    if (const YAML::Node candidates = config["candidates"]) {
      const Vec3 center = run.map ? run.map->enclosure_center() : Vec3(Vec3::Zero());
      run.candidates = candidates_from_text(candidates.as<std::string>(), center);
    }
  } catch (const YAML::Exception& error) {
    throw InputError(concat(path.string(), ": ", error.what()));
  }
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
  if (has("summary.json")) read_summary(run, folder / "summary.json");
  if (has("config.yaml")) read_config(run, folder / "config.yaml");
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
