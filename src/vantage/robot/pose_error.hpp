#pragma once

#include "vantage/robot/positioning_error.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// How far from a commanded pose the sensor ends up, position and orientation: normally distributed. Entries 0..2 are
/// the position in the world frame, metres; 3..5 are pan, tilt and roll, radians: a turn about the sensor's own axes
/// down (y), right (x) and forward (z), together one rotation vector in the commanded sensor frame.
struct PoseError {
  using Vector = Eigen::Matrix<double, 6, 1>;
  using Matrix = Eigen::Matrix<double, 6, 6>;

  Vector mean = Vector::Zero();
  Matrix covariance = Matrix::Zero();

  PoseError() = default;
  /// An error of the position alone.
  PoseError(const PositioningError& position);  // NOLINT(google-explicit-constructor): it is the special case
  /// Independent errors: standard deviations per world axis (metres) and of pan, tilt and roll (radians). Throws
  /// InputError where one is negative.
  [[nodiscard]] static PoseError from_deviations(const Vec3& sigma_position, const Vec3& sigma_orientation);

  [[nodiscard]] PositioningError position() const;
  [[nodiscard]] bool is_zero() const { return mean.isZero(0) && covariance.isZero(0); }
  /// True where pan, tilt and roll are always as commanded.
  [[nodiscard]] bool keeps_orientation() const;
  /// Throws InputError unless all is finite and the covariance symmetric and positive semi-definite.
  void validate() const;
};

/// The pose that a move to `commanded` ends at with this error (in the order of PoseError).
[[nodiscard]] View displaced(const View& commanded, const PoseError::Vector& error);

/// The error that took `commanded` to `reached`: what displaced() undoes.
[[nodiscard]] PoseError::Vector error_between(const View& commanded, const View& reached);

/// A matrix whose product with its transpose is the covariance; diagonal where the covariance is, so that each axis
/// keeps its own random numbers. `covariance` must be positive semi-definite, 3x3 or 6x6.
[[nodiscard]] Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance);

}  // namespace vantage
