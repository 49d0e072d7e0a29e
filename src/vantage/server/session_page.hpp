#pragma once

#include <mutex>
#include <string>

#include "vantage/runs/run_data.hpp"
#include "vantage/server/live_run.hpp"
#include "vantage/session/session.hpp"

namespace vantage {

/// A session as the page shows it (docs/report-data.md, "Live"): every member tells a LiveRun. Any thread may call any
/// member.
class SessionPage {
 public:
  /// Begins with the map before the first scan. `run` must outlive this.
  SessionPage(const ScanPlanningOptions& options, const std::string& name, LiveRun& run);

  /// The model after one scan more. One with no more scans than are shown starts again: some were taken out or put
  /// back.
  void add_scan(const SessionModel& model);
  /// Shows no scan any more.
  void clear();
  /// What is planned on the scans so far; nothing is shown where there are others by now.
  void add_plan(const SessionPlan& plan);
  /// Somebody goes to take this view.
  void add_take(const Evaluation& view);
  /// The document of the report that finish() wrote.
  void add_result(const LiveRun::Json& report);

 private:
  void begin();
  void set_up(double radius, const std::optional<RangeCamera>& camera);

  std::mutex mutex_;
  LiveRun& run_;
  ScanPlanningOptions options_;
  RunData data_;           // without the scans, which the LiveRun has
  std::size_t scans_ = 0;  // that are shown
  double radius_ = 0;      // of the view sphere as it is shown
  bool has_camera_ = false;
  std::optional<CandidatePlan> plan_;  // on all scans so far
  bool is_finished_ = false;
};

}  // namespace vantage
