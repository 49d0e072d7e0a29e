#include "vantage/io/scan_planning_options.hpp"

#include "vantage/io/robot_file.hpp"

namespace vantage {

void ScanPlanningOptions::validate() const {
  scene.validate();
  reading.validate();
  (void)camera(std::nullopt);
  planning.planner_options().validate();
}

RangeCamera ScanPlanningOptions::camera(const std::optional<RangeCamera>& of_scans) const {
  RangeCamera camera = of_scans.value_or(planning.range_camera());
  camera.min_depth = reading.depth_range[0];
  camera.max_depth = reading.depth_range[1];
  camera.validate();
  return camera;
}

Planner ScanPlanningOptions::planner(const Candidates& candidates, const std::optional<RangeCamera>& of_scans) const {
  ReconstructOptions options = planning;
  if (options.robot && !options.robot_model) {
    // Options that come with the robot were applied, or not, when these ones were made.
    std::set<std::string> given;
    for (const OptionField& field : option_fields(options)) given.insert(field.name);
    load_robot(options, given);
  }
  return Planner(candidates, camera(of_scans), options.planner_options());
}

std::vector<OptionField> option_fields(ScanPlanningOptions& options) {
  std::vector<OptionField> fields = option_fields(options.scene);
  for (OptionField& field : option_fields(options.reading)) fields.push_back(std::move(field));
  for (OptionField& field : fields_named(option_fields(options.planning), planning_option_names())) {
    // The depth range is that of the scans, and the candidates are a sphere around the box.
    if (field.name != "depth-range" && field.name != "candidates") fields.push_back(std::move(field));
  }
  return fields;
}

}  // namespace vantage
