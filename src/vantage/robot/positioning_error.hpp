#pragma once

#include "vantage/core/geometry.hpp"

namespace vantage {

/// How far from a commanded position the robot ends up: normally distributed, world frame.
struct PositioningError {
  Vec3 mean = Vec3::Zero();        // metres
  Mat3 covariance = Mat3::Zero();  // square metres

  [[nodiscard]] static PositioningError from_deviations(const Vec3& sigma);
  [[nodiscard]] bool is_zero() const { return mean.isZero(0) && covariance.isZero(0); }
  /// True where the axes err independently.
  [[nodiscard]] bool is_diagonal() const;
  /// Throws InputError unless all is finite and the covariance symmetric and positive semi-definite.
  void validate() const;
};

}  // namespace vantage
