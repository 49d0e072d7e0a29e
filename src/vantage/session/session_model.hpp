#pragma once

#include "vantage/model/scan_model.hpp"
#include "vantage/options/scan_planning_options.hpp"
#include "vantage/session/session_scan.hpp"

namespace vantage {

/// A session's state after some scan; it never changes, so that any thread may read it.
struct SessionState {
  VoxelMap map;
  std::vector<ScanRecord> scans;
  std::vector<int> numbers;              // of the scans in the session's folder
  View current;                          // where the sensor was at the last scan
  double radius = 0;                     // of the view sphere
  std::optional<RangeCamera> camera;     // of the first depth image
  std::map<int, std::string> set_aside;  // candidates whose scans failed since the map changed last, with the reason
  bool box_was_seen = false;             // some merged scan has a point in the box
  SensorModel sensor;                    // how the sensor errs, as far as that is known
  std::optional<ErrorLearner> learner;   // where the options ask for it: what the robot's errors have taught
};

/// The scans of a session merged one after the other, exactly as `plan` merges them.
class SessionModel {
 public:
  explicit SessionModel(const ScanPlanningOptions& options);

  /// Merges a scan where `known` put it, or else where registration puts it. Returns what registration found.
  Located add(int number, const SessionScan& scan, const std::optional<Located>& known);

  /// When no scan follows: tries those once more that were refused, and improves all poses together.
  void conclude() { (void)scans_.conclude(*registrar_); }

  [[nodiscard]] const ObjectModel& model() const { return scans_.model(); }
  /// Of the scans in the session's folder, in the order of model().scans.
  [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }
  /// Of the view sphere, metres: as given, or the median distance of the sensor from the box's center at the scans that
  /// were merged; 0 before the first.
  [[nodiscard]] double radius() const;
  /// Of the first depth image.
  [[nodiscard]] const std::optional<RangeCamera>& camera() const { return camera_; }
  [[nodiscard]] SessionState state() const;

 private:
  /// Where the sensor was sent for this scan: as it says, or to the candidate that it says. Nothing where it was not
  /// planned.
  [[nodiscard]] std::optional<View> commanded(const SessionScan& scan) const;
  void note_candidate(const SessionScan& scan, const ScanRecord& record);

  std::optional<double> given_radius_;
  int views_;  // on the view sphere
  Box3 box_;
  std::unique_ptr<Registrar> registrar_;
  ScanModel scans_;
  std::vector<int> numbers_;
  std::optional<RangeCamera> camera_;
  std::map<int, std::string> set_aside_;
  bool box_was_seen_ = false;  // by a merged scan
};

/// The box of a session's options. Throws InputError where they have none.
[[nodiscard]] Box3 session_box(const ScanPlanningOptions& options);

/// The planner for this state, with the candidates that were skipped or set aside.
[[nodiscard]] Planner session_planner(const ScanPlanningOptions& options, const SessionState& state,
                                      const std::map<int, std::string>& skipped);

}  // namespace vantage
