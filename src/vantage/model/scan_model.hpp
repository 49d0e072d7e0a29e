#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "vantage/model/from_scans.hpp"
#include "vantage/model/scan_cleaner.hpp"
#include "vantage/planning/planner.hpp"
#include "vantage/robot/error_learner.hpp"

namespace vantage {

/// Finds the poses of real scans: ICP with what noisy frames and good robots ask for, or the poses as they are.
[[nodiscard]] std::unique_ptr<Registrar> make_registrar(const ScanPlanOptions& options, const ScanScene& scene);

/// What is known of how a scan came about.
struct ScanOrigin {
  std::string name;                    // becomes the reason in its record
  int candidate = -1;                  // the view it was planned as; -1 where it was not planned
  std::optional<View> commanded = {};  // where the sensor was sent, if that is known
};

/// What real scans, merged one after the other, come to.
class ScanModel {
 public:
  explicit ScanModel(const ScanScene& scene);

  /// Learns how the robot errs from every merged scan whose commanded view is known; none by default.
  std::optional<ErrorLearner> learner;

  /// Takes out flying pixels, registers the scan, merges it where that succeeds, and notes it.
  const ScanRecord& add(const ScanOrigin& origin, const Scan& measured, const View& believed, Registrar& registrar);

  /// When no scan follows for now: tries those once more that were refused. Returns the numbers of those that came in.
  std::vector<int> conclude(Registrar& registrar) { return vantage::conclude(model_, registrar); }

  [[nodiscard]] const ObjectModel& model() const { return model_; }
  /// Median distance of the sensor from the middle of the scene at the scans that were merged, metres; 0 before the
  /// first. One with a wrong pose hardly moves it.
  [[nodiscard]] double sensor_distance() const { return typical_distance(distances_); }
  /// Whether the options say how the sensor errs; else model().sensor is an estimate from the scans.
  [[nodiscard]] bool sensor_is_given() const { return cleaner_.is_given(); }
  /// Where the sensor is: at its last scan, in the middle of its sight lines' origins.
  [[nodiscard]] const View& current() const { return current_; }

 private:
  ObjectModel model_;
  Vec3 center_;                    // of the scene
  std::vector<double> distances_;  // of the sensor from there, metres, at merged scans
  ScanCleaner cleaner_;
  View current_;
  std::set<int> with_command_;  // numbers of scans of which it is known where the sensor was sent
};

/// Tells a planner from where scans were merged, as the loop of a run does after each of them: utilities with a memory
/// ask for it. A scan that was not planned counts as taken from the candidate that it stands at, if there is one: to
/// 1 % of the distance to the center and 1 degree.
void tell_of_scans(Planner& planner, std::span<const ScanRecord> scans);

}  // namespace vantage
