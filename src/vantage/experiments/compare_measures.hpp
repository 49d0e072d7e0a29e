#pragma once

#include <array>
#include <string>
#include <vector>

#include "vantage/experiments/run_outcome.hpp"
#include "vantage/robot/robot_time.hpp"

namespace vantage {

/// What compare says of one run, or of the runs from one start summed over the objects.
struct CompareMeasures {
  static constexpr std::array<double, 4> goals{0.90, 0.95, 0.98, 0.99};

  std::array<double, 4> views{};  // to each of the goals; a run that misses one counts with `budget` views
  double distance = 0;            // metres to the last goal, or of the whole run where it misses it
  double seconds = 0;             // of scans and path to the last goal; a run that misses it counts with `budget` scans
  double missed = 0;              // 1 where the last goal was missed
  double area_under_curve = 0;    // mean coverage after scans 1 .. curve_length, per cent
  double min_overlap = 1;         // over the scans up to the last goal, the first left out
  double mean_overlap = 0;
  double accuracy = 0;  // metres, RMS of the whole run's model

  static constexpr std::size_t curve_length = 20;
};

/// `budget`: scans that a run may take. `coverage`: the outcome's list that goals and curve are of.
[[nodiscard]] CompareMeasures measure_run(const RunOutcome& outcome, int budget, const std::string& coverage,
                                          const RobotTime& time = {});

/// Sums of views, distances, seconds, misses; means of the others; the least of the least overlaps.
[[nodiscard]] CompareMeasures over_objects(const std::vector<CompareMeasures>& objects);

/// Ranks 1, 2, ... of values, least first; equal values share the mean of their ranks.
[[nodiscard]] std::vector<double> ranks_of(const std::vector<double>& values);

}  // namespace vantage
