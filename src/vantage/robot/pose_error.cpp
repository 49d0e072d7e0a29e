#include "vantage/robot/pose_error.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/robot/error_limits.hpp"

namespace vantage {
namespace {

/// Pan, tilt and roll turn about y, x and z.
Vec3 rotation_vector(const Vec3& pan_tilt_roll) { return {pan_tilt_roll[1], pan_tilt_roll[0], pan_tilt_roll[2]}; }

bool is_diagonal(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      if (row != column && matrix(row, column) != 0) return false;
    }
  }
  return true;
}

}  // namespace

PoseError::PoseError(const PositioningError& position) {
  mean.head<3>() = position.mean;
  covariance.topLeftCorner<3, 3>() = position.covariance;
}

PoseError PoseError::from_deviations(const Vec3& sigma_position, const Vec3& sigma_orientation) {
  require(sigma_orientation.allFinite() && (sigma_orientation.array() >= 0).all() &&
              (sigma_orientation.array() <= largest_turn_error).all(),
          "orientation error: standard deviations ", sigma_orientation.transpose(), " rad: must be from 0 to ",
          largest_turn_error, " rad");
  PoseError error(PositioningError::from_deviations(sigma_position));
  error.covariance.bottomRightCorner<3, 3>() = sigma_orientation.cwiseAbs2().asDiagonal();
  return error;
}

PositioningError PoseError::position() const { return {mean.head<3>(), covariance.topLeftCorner<3, 3>()}; }

bool PoseError::keeps_orientation() const {
  return mean.tail<3>().isZero(0) && covariance.bottomRightCorner<3, 3>().isZero(0);
}

void PoseError::validate() const {
  require(mean.allFinite(), "pose error: mean ", mean.transpose(), ": must be finite numbers");
  require(covariance.allFinite(), "pose error: the covariance has an entry that is not a finite number");
  const double scale = covariance.cwiseAbs().maxCoeff();
  require((covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale,
          "pose error: the covariance is not symmetric");
  for (int i = 0; i < 6; ++i) {
    const double largest = i < 3 ? largest_position_error : largest_turn_error;
    const char* const unit = i < 3 ? " m" : " rad";
    require(std::abs(mean[i]) <= largest, "pose error: mean ", mean[i], unit, ": must be within ", largest, unit);
    require(covariance(i, i) <= largest * largest, "pose error: a standard deviation of ", std::sqrt(covariance(i, i)),
            unit, ": must be at most ", largest, unit);
  }
  if (scale <= 0) return;
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues()[0];
  require(least >= -1e-9 * scale, "pose error: the covariance has the eigenvalue ", least,
          ": it must be positive semi-definite");
}

View displaced(const View& commanded, const PoseError::Vector& error) {
  View reached = commanded;
  reached.world_from_sensor.translation() += error.head<3>();
  const Vec3 turn = rotation_vector(error.tail<3>());
  const double angle = turn.norm();
  if (angle > 0) {
    reached.world_from_sensor.linear() =
        commanded.world_from_sensor.linear() * Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
  return reached;
}

PoseError::Vector error_between(const View& commanded, const View& reached) {
  PoseError::Vector error;
  error.head<3>() = reached.position() - commanded.position();
  const Mat3 difference = commanded.world_from_sensor.linear().transpose() * reached.world_from_sensor.linear();
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(difference).normalized());
  error.tail<3>() = rotation_vector(turn.angle() * turn.axis());  // exchanging two entries undoes itself
  return error;
}

Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  if (is_diagonal(covariance)) return covariance.diagonal().cwiseMax(0).cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
  // Rounding may leave eigenvalues a little below zero where the covariance is singular.
  const Eigen::VectorXd deviations = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  return axes.eigenvectors() * deviations.asDiagonal();
}

}  // namespace vantage
