#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vantage/registration/pose_estimate.hpp"

namespace vantage {

/// What registering two overlapping scans with each other found: where `to` was, seen from `from`.
struct PoseConstraint {
  std::size_t from = 0, to = 0;
  Pose from_of_to = Pose::Identity();  // takes the frame of sensor `to` to that of sensor `from`
  /// Inverse covariance of pose_step(from_of_to, the true one), in the frame of `from`. Directions that the overlap
  /// leaves open are 0 in it.
  Mat6 information = Mat6::Zero();
};

/// What is believed of one pose by itself, for example because the robot says so.
struct PosePrior {
  std::size_t pose = 0;
  Pose world_from_sensor = Pose::Identity();
  Mat6 information = Mat6::Zero();  // inverse covariance of pose_step(this pose, the true one)
};

/// Poses of scans, and what is known of them alone and in pairs.
struct PoseGraph {
  std::vector<Pose> poses;  // world from sensor; where the search begins
  std::vector<PosePrior> priors;
  std::vector<PoseConstraint> constraints;

  /// Throws InputError naming the prior or constraint and what is wrong with it, or a pose that no prior reaches.
  void validate() const;
};

struct PoseGraphOptions {
  int max_iterations = 50;
  double tolerance = 1e-7;  // metres and radians: it has converged where no step is longer
  /// Squared Mahalanobis distance (chi squared, six degrees of freedom) at which a constraint counts half: a right one
  /// exceeds this once in a hundred times.
  double outlier_distance = 16.81;

  void validate() const;
};

struct SolvedPoses {
  std::vector<Pose> poses;      // in the order of the graph's
  std::vector<double> weights;  // per constraint, 0..1: how far it is believed
  int iterations = 0;
  bool converged = false;
};

/// The poses that agree best with all priors and constraints: Gauss-Newton with Cauchy weights on the constraints,
/// which are sharpened from least squares, so that neither a loop that does not close yet nor a wrong pair decides. One
/// thread, fixed order: always the same bits. Throws InputError as validate() does.
[[nodiscard]] SolvedPoses solve(const PoseGraph& graph, const PoseGraphOptions& options = {});

/// The step of a constraint at these poses, in the world: how far `to` is from where `from` claims it to be.
[[nodiscard]] Vec6 residual(const PoseConstraint& constraint, std::span<const Pose> poses);

}  // namespace vantage
