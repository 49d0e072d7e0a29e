#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/core/normal_points.hpp"
#include "vantage/robot/pose_error.hpp"

namespace vantage {

/// One error that a move may end with, in the order of PoseError, and how much it counts.
struct PoseSample {
  PoseError::Vector error = PoseError::Vector::Zero();
  double weight = 1;
};

/// A deterministic set of errors with the given mean and covariance; directions in which the robot does not err take
/// none of the points. The weights sum up to 1. A robot without variance has one sample.
[[nodiscard]] std::vector<PoseSample> pose_samples(const PoseError& error, int count);

}  // namespace vantage
