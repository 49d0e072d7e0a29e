#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/robot/pose_error.hpp"
#include "vantage/search/search.hpp"

namespace vantage {

/// Seconds that the steps of one scan took.
struct ScanTimings {
  double plan = 0;
  double scan = 0;
  double registration = 0;
  double integration = 0;

  [[nodiscard]] double total() const { return plan + scan + registration + integration; }
};

/// Voxels of each label in the enclosure after a scan.
struct LabelCounts {
  std::int64_t unmarked = 0, occupied = 0, empty = 0, occluded = 0, occplane = 0;
};

/// One scan of a reconstruction: where from, why, and what it brought (a row of views.csv; spec, section 10).
struct ScanRecord {
  int scan = 0;        // from 0
  int candidate = -1;  // -1: not one of the candidate views
  View commanded, believed, registered;
  std::optional<Evaluation> planned;  // what the planner expected; nothing for scans it did not choose
  std::string reason;                 // why this view was taken

  LabelCounts labels;
  std::int64_t new_occupied = 0;
  std::int64_t taken_back = 0;  // occupied voxels that this scan looked through, so that they are empty now
  std::int64_t flying = 0;      // pixels taken out as flying
  double mean_quality = 0;
  double distance = 0;                           // metres travelled so far, without the way to the first view
  std::optional<double> coverage, coverage_all;  // known in simulation only
  std::optional<View> true_view;                 // known in simulation only
  std::optional<double> pose_error;              // the same: how far its points are off the truth in the mean, metres

  bool merged = true;  // false where registration failed: kept, but not in the map
  /// The scan after which it came into the map: its own number, or that of a later one where it was refused at first.
  std::optional<int> merged_after;
  std::vector<int> recovered;  // earlier scans that came into the map after this one
  double overlap = 1;          // share of the scan that lies on the model, as registration saw it
  double residual = 0;         // metres
  std::string verdict;
  std::string detail;  // a sentence about the verdict
  /// Of the registered pose, as PoseEstimate has it; 0 where the pose was taken as it was.
  PoseError::Matrix pose_covariance = PoseError::Matrix::Zero();
  int undetermined_directions = 0;  // of the registered pose: there it stays as believed
  /// How the robot errs as far as it has been learned up to this scan; nothing where it is not learned.
  std::optional<PoseError> learned_error;
  ScanTimings timings;
};

}  // namespace vantage
