#pragma once

#include <functional>
#include <limits>

#include "vantage/model/object_model.hpp"
#include "vantage/planning/planner.hpp"
#include "vantage/robot/robot.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// When to stop although there is more to see (spec, section 5).
struct Budget {
  int max_views = 40;
  double max_distance = std::numeric_limits<double>::infinity();  // as moves are counted: metres, or radians of joints
  double max_time = std::numeric_limits<double>::infinity();      // seconds
  int max_fruitless_scans = 4;  // in a row, merged without a new occupied voxel; refused ones do not count

  void validate() const;
};

/// Algorithm 1 of the paper: scan, update, plan, move, until nothing is left to see. The members are what it works
/// with; a caller replaces those it needs.
class Reconstruction {
 public:
  Reconstruction(Robot& robot, Planner& planner, Registrar& registrar)
      : robot_(robot), planner_(planner), registrar_(registrar) {}

  Budget budget;
  QualityReference quality = QualityReference::axis;
  /// Learns how the robot errs from every merged scan and tells the planner; none by default.
  std::optional<ErrorLearner> learner;
  /// Called with each finished record before it is added to the model; may add what only the caller knows (coverage).
  std::function<void(ScanRecord&, const Scan&, const ObjectModel&, const Plan*)> on_scan =
      [](ScanRecord&, const Scan&, const ObjectModel&, const Plan*) {};
  /// Called with each plan before the robot moves.
  std::function<void(const Plan&)> on_plan = [](const Plan&) {};
  /// Asked between scans; true ends the reconstruction with what has been scanned so far.
  std::function<bool()> interrupted = [] { return false; };

  /// Called once when all scans are done and refused ones have been tried a last time; may add to the records what only
  /// the caller knows.
  std::function<void(ObjectModel&)> on_end = [](ObjectModel&) {};

  /// Starts at candidate `initial_candidate`. Throws InputError where it is not feasible.
  void run(ObjectModel& model, int initial_candidate);
  /// Why run() ended.
  [[nodiscard]] const std::string& stop_reason() const { return stop_reason_; }

 private:
  void explore(ObjectModel& model, int initial_candidate);
  void scan_and_update(ObjectModel& model, const View& commanded, const Plan* plan, int candidate, double plan_seconds);
  void learn_from(ObjectModel& model, ScanRecord& record);
  [[nodiscard]] std::string why_stop(const ObjectModel& model, double seconds) const;

  Robot& robot_;
  Planner& planner_;
  Registrar& registrar_;
  std::string stop_reason_;
};

}  // namespace vantage
