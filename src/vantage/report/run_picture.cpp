#include "vantage/report/run_picture.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/report/run_scene.hpp"

namespace vantage {

ReportData report_data(const StoredRun& run) {
  ReportData data;
  data.object = run.object;
  data.camera = run.camera;
  data.candidates = run.candidates;
  data.scans = run.scans;
  data.map = run.map ? &*run.map : nullptr;
  data.cloud = &run.cloud;
  data.mesh = &run.mesh;
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
  const ReportData data = report_data(run);
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
