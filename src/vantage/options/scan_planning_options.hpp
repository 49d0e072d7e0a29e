#pragma once

#include <vector>

#include "vantage/model/from_scans.hpp"
#include "vantage/options/options.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// All that decides what is planned on real scans: the options of `plan` and of sessions.
struct ScanPlanningOptions {
  ScanPlanOptions scene;        // where the object is, and how scans are registered
  ScanFolderOptions reading;    // what the files mean
  ReconstructOptions planning;  // camera (where the scans bring none), utility, search and reach

  /// Throws InputError naming the option.
  void validate() const;
  /// The same, and that nothing is to be learned of commanded views, which a folder of scans does not tell.
  void validate_without_commands() const;
  /// Throws InputError naming the option where no view could ever be planned in the scene, whatever scans come.
  void require_can_plan(const SceneOptions& fitted) const;
  /// The camera that views are planned for: that of the scans where they have one, with the depth range of the options.
  [[nodiscard]] RangeCamera camera(const std::optional<RangeCamera>& of_scans) const;
  /// Reads the robot's file, where one is named and not read yet; otherwise each planner() reads it, and forgets what
  /// the robot has computed. Throws InputError with the file and the line.
  void load_robot_model();
  [[nodiscard]] Planner planner(const Candidates& candidates, const std::optional<RangeCamera>& of_scans) const;
};

/// The options in the order of the help. They must outlive the fields.
[[nodiscard]] std::vector<OptionField> option_fields(ScanPlanningOptions& options);

}  // namespace vantage
