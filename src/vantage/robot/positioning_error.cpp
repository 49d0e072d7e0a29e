#include "vantage/robot/positioning_error.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/robot/error_limits.hpp"

namespace vantage {

PositioningError PositioningError::from_deviations(const Vec3& sigma) {
  require(sigma.allFinite() && (sigma.array() >= 0).all() && (sigma.array() <= largest_position_error).all(),
          "positioning error: standard deviations ", sigma.transpose(), " m: must be from 0 to ",
          largest_position_error, " m");
  PositioningError error;
  error.covariance = sigma.cwiseAbs2().asDiagonal();
  return error;
}

bool PositioningError::is_diagonal() const {
  return Mat3(covariance.diagonal().asDiagonal()).isApprox(covariance, 0) || covariance.isZero(0);
}

void PositioningError::validate() const {
  require(mean.allFinite(), "positioning error: mean ", mean.transpose(), " m: must be finite numbers");
  require(covariance.allFinite(), "positioning error: the covariance has an entry that is not a finite number");
  const double scale = covariance.cwiseAbs().maxCoeff();
  require((covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale,
          "positioning error: the covariance is not symmetric");
  require(mean.cwiseAbs().maxCoeff() <= largest_position_error, "positioning error: mean ", mean.transpose(),
          " m: must be within ", largest_position_error, " m; are the units metres?");
  require(scale <= largest_position_error * largest_position_error, "positioning error: a standard deviation of ",
          std::sqrt(scale), " m: must be at most ", largest_position_error, " m; are the units metres?");
  if (scale <= 0) return;
  const double least = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvalues()[0];
  require(least >= -1e-9 * scale, "positioning error: the covariance has the eigenvalue ", least,
          " m^2: it must be positive semi-definite");
}

}  // namespace vantage
