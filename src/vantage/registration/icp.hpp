#pragma once

#include <vector>

#include "vantage/registration/normal_equations.hpp"
#include "vantage/registration/point_index.hpp"
#include "vantage/registration/surfels.hpp"

namespace vantage {

/// Model and scan at one resolution.
class IcpLevel {
 public:
  /// Both clouds reduced to surfels of side `cell`; the model in the world frame, the scan in the sensor frame.
  IcpLevel(const PointCloud& model, const PointCloud& scan, double cell);

  [[nodiscard]] double cell() const { return model_.cell; }
  [[nodiscard]] const Surfels& model() const { return model_; }
  [[nodiscard]] const Surfels& scan() const { return scan_; }

  /// Which partners count: at borders of the known model the surface goes on where nobody has looked, so a pair there
  /// pulls sideways; it still tells that model and scan meet.
  enum class Borders { left_out, included };
  /// Each scan surfel with the model surfel nearest to it, where that is nearer than `max_distance` and faces the same
  /// way. All weights are 1.
  [[nodiscard]] std::vector<PlanePair> pairs(const Pose& world_from_sensor, double max_distance, Borders borders) const;

 private:
  Surfels model_;
  PointIndex model_index_;
  Surfels scan_;
};

struct IcpSettings {
  double max_distance = 0;  // between partners, metres
  double least_eigenvalue = 0;
  int max_iterations = 0;
};

struct IcpResult {
  Pose world_from_sensor = Pose::Identity();
  bool converged = false;
  NormalEquations equations;  // of the last iteration
  int undetermined_directions = 0;
};

/// Iterates from `start`; directions that the pairs leave open are drawn to `believed`.
[[nodiscard]] IcpResult align(const IcpLevel& level, const Pose& start, const Pose& believed, const MotionFrame& frame,
                              const IcpSettings& settings);

/// Normal equations over all surfels of model and scan, at a pose: how far the shape as a whole resists motions.
[[nodiscard]] NormalEquations resistance(const IcpLevel& level, const Pose& world_from_sensor,
                                         const MotionFrame& frame);

/// How well the scan lies on the model at a pose.
struct Agreement {
  double overlap = 0;   // share of the scan's surfels on the model
  double residual = 0;  // their RMS distance to the model's planes, metres
  double score = 0;     // share of the surfels, each counted by how close it is
};

[[nodiscard]] Agreement agreement(const IcpLevel& level, const Pose& world_from_sensor);

}  // namespace vantage
