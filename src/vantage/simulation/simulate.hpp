#pragma once

#include <memory>

#include "vantage/model/reconstruction.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/simulation/ground_truth.hpp"
#include "vantage/simulation/simulated_robot.hpp"

namespace vantage {

/// An object in the simulator with what there is to see of it. Built once, then shared by any number of runs.
class SimulatedObject {
 public:
  /// `mesh` in any unit and place: it is centred and scaled to `size` metres.
  SimulatedObject(const TriangleMesh& mesh, double size, const ReconstructOptions& options);

  [[nodiscard]] const RangeScanner& scanner() const { return *scanner_; }
  [[nodiscard]] const GroundTruth& truth() const { return *truth_; }

 private:
  std::unique_ptr<RangeScanner> scanner_;
  std::unique_ptr<GroundTruth> truth_;
};

/// How the robot of these options errs.
[[nodiscard]] SimulatedRobotOptions simulated_robot_options(const ReconstructOptions& options);

/// What a run tells while it goes on.
struct RunObserver {
  std::function<void(const ScanRecord&, const Scan&, const ObjectModel&, const Plan*)> on_scan =
      [](const ScanRecord&, const Scan&, const ObjectModel&, const Plan*) {};
  std::function<void(const Plan&)> on_plan = [](const Plan&) {};
  std::function<bool()> interrupted = [] { return false; };
};

struct SimulatedRun {
  ObjectModel model;
  std::string stop_reason;
};

/// A whole reconstruction in simulation (Algorithm 1), as the options say; with `utility`, if there is one, instead of
/// the one that they name.
[[nodiscard]] SimulatedRun simulate(const SimulatedObject& object, const ReconstructOptions& options,
                                    const RunObserver& observer = {}, const std::optional<Utility>& utility = {});

}  // namespace vantage
