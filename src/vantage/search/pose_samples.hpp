#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/robot/pose_error.hpp"

namespace vantage {

/// One error that a move may end with, in the order of PoseError, and how much it counts.
struct PoseSample {
  PoseError::Vector error = PoseError::Vector::Zero();
  double weight = 1;
};

/// x with Phi(x) = `share` for the standard normal distribution; `share` in (0, 1).
[[nodiscard]] double normal_quantile(double share);

/// `count` points that stand for a standard normal distribution: one per column, equally weighted, always the same.
/// They follow an additive low-discrepancy sequence, come in pairs z and -z, and have exactly the mean 0 and the
/// covariance I, so that functions up to the third degree are averaged exactly. Throws InputError unless `count` is
/// even and at least twice the dimensions.
[[nodiscard]] Eigen::MatrixXd normal_points(int dimensions, int count);

/// A deterministic set of errors with the given mean and covariance; directions in which the robot does not err take
/// none of the points. The weights sum up to 1. A robot without variance has one sample.
[[nodiscard]] std::vector<PoseSample> pose_samples(const PoseError& error, int count);

}  // namespace vantage
