#include "vantage/options/scan_planning_options.hpp"

#include "vantage/core/error.hpp"
#include "vantage/options/robot_file.hpp"

namespace vantage {

namespace {

/// A single plan shows the rest of the scan too.
PlannerOptions telling(const ReconstructOptions& planning) {
  PlannerOptions options = planning.planner_options();
  options.tells_tour = true;
  return options;
}

}  // namespace

void ScanPlanningOptions::validate() const {
  scene.validate();
  reading.validate();
  (void)camera(std::nullopt);
  planning.validate_errors(planning.center);
  require(planning.convolve == "off" || planning.believed_error || planning.believed_covariance ||
              planning.believed_orientation_error || planning.believed_growth || planning.believed_mean,
          "convolve = ", planning.convolve,
          ": needs how the robot errs; give believed-error as SX,SY,SZ or, in a session, learn");
  planning.planner_options().validate();
}

void ScanPlanningOptions::validate_without_commands() const {
  require(
      !planning.learns_error(), "believed-error = ", planning.believed_error.value_or(""),
      ": scans in a folder do not say where the sensor was sent; give the deviations as SX,SY,SZ, or use a session, "
      "which is given");
  validate();
}

void ScanPlanningOptions::require_can_plan(const SceneOptions& fitted) const {
  const double radius = scene.radius.value_or(fitted.voxel_length * fitted.enclosure_size.cast<double>().norm());
  const Planner trial = planner(view_sphere(scene.views, radius, fitted.center), std::nullopt);
  (void)ideal_resolution(trial.camera(), fitted.voxel_length, radius);
}

RangeCamera ScanPlanningOptions::camera(const std::optional<RangeCamera>& of_scans) const {
  RangeCamera camera = of_scans.value_or(planning.range_camera());
  camera.min_depth = reading.depth_range[0];
  camera.max_depth = reading.depth_range[1];
  camera.validate();
  return camera;
}

Planner ScanPlanningOptions::planner(const Candidates& candidates, const std::optional<RangeCamera>& of_scans) const {
  if (!planning.robot || planning.robot_model) return Planner(candidates, camera(of_scans), telling(planning));
  ScanPlanningOptions copy = *this;
  copy.load_robot_model();
  return Planner(candidates, camera(of_scans), telling(copy.planning));
}

void ScanPlanningOptions::load_robot_model() {
  if (!planning.robot || planning.robot_model) return;
  // Options that come with the robot were applied, or not, when these ones were made.
  std::set<std::string> given;
  for (const OptionField& field : option_fields(planning)) given.insert(field.name);
  load_robot(planning, given);
}

std::vector<OptionField> option_fields(ScanPlanningOptions& options) {
  std::vector<OptionField> fields = option_fields(options.scene);
  for (OptionField& field : option_fields(options.reading)) fields.push_back(std::move(field));
  for (OptionField& field : fields_named(option_fields(options.planning), planning_option_names())) {
    // The depth range is that of the scans, and the candidates are a sphere around the box.
    if (field.name != "depth-range" && field.name != "candidates") fields.push_back(std::move(field));
  }
  for (OptionField& field : fields_named(option_fields(options.planning), believed_error_option_names()))
    fields.push_back(std::move(field));
  return fields;
}

}  // namespace vantage
