#pragma once

#include <Eigen/Core>

#include "vantage/core/geometry.hpp"

namespace vantage {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// The small motion that takes pose `from` to pose `to`, seen from the frame that the poses lead to (the world's side):
/// entries 0..2 are the difference of the sensor's positions, metres; 3..5 the rotation vector about the world's axes
/// of `to` against `from`, radians. The sensor turns about its own position: the two parts do not mix.
[[nodiscard]] Vec6 pose_step(const Pose& from, const Pose& to);
/// The pose that a step leads to: what pose_step() undoes.
[[nodiscard]] Pose stepped(const Pose& from, const Vec6& step);

/// How a step of a frame moves another one that is fixed to it at `arm` from its origin (world axes, metres): step of
/// the other = effect * step. It is turned by the same and carried along.
[[nodiscard]] Mat6 effect_at(const Vec3& arm);

/// A pose (world from sensor, or frame a from frame b) that is known up to a normally distributed error: `covariance`
/// is that of pose_step(mean, true pose), m^2, m rad and rad^2. Directions without variance are known exactly.
struct PoseEstimate {
  Pose mean = Pose::Identity();
  Mat6 covariance = Mat6::Zero();

  /// Independent errors with these standard deviations about every axis: metres, radians.
  [[nodiscard]] static PoseEstimate around(const Pose& mean, double sigma_position, double sigma_angle);
  /// Throws InputError unless all is finite and the covariance is symmetric and positive semi-definite.
  void validate() const;
};

/// A root of a covariance with a column for each direction in which there is any variance: step = root * u with a
/// standard normal u.
[[nodiscard]] Eigen::Matrix<double, 6, Eigen::Dynamic> root_of_variances(const Mat6& covariance);

/// The inverse of a pose's covariance. What is known exactly counts as known to a micrometre and a microradian.
[[nodiscard]] Mat6 inverse_covariance(const Mat6& covariance);

/// The quantile of the chi-squared distribution that 99.9 % stay below; `degrees_of_freedom` in 1..6.
[[nodiscard]] double chi_squared_limit(int degrees_of_freedom);

}  // namespace vantage
