#include "vantage/registration/pose_estimate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {

Vec6 pose_step(const Pose& from, const Pose& to) {
  const Eigen::AngleAxisd rotation(Mat3(to.linear() * from.linear().transpose()));
  Vec6 step;
  step << to.translation() - from.translation(), rotation.angle() * rotation.axis();
  return step;
}

Pose stepped(const Pose& from, const Vec6& step) {
  Pose pose = from;
  pose.translation() += step.head<3>();
  const Vec3 rotation_vector = step.tail<3>();
  const double angle = rotation_vector.norm();
  if (angle > 0) {
    pose.linear() = Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix() * from.linear();
  }
  return pose;
}

Mat6 effect_at(const Vec3& arm) {
  Mat6 effect = Mat6::Identity();
  effect.topRightCorner<3, 3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  return effect;
}

PoseEstimate PoseEstimate::around(const Pose& mean, double sigma_position, double sigma_angle) {
  Vec6 variances;
  variances << Vec3::Constant(sigma_position * sigma_position), Vec3::Constant(sigma_angle * sigma_angle);
  return {mean, variances.asDiagonal()};
}

void PoseEstimate::validate() const {
  require(mean.matrix().allFinite() && covariance.allFinite(), "pose estimate: a value is not finite");
  const double scale = covariance.diagonal().cwiseAbs().maxCoeff();
  require((covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale,
          "pose estimate: the covariance must be symmetric");
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(covariance, Eigen::EigenvaluesOnly);
  require(solver.eigenvalues().minCoeff() >= -1e-9 * scale, "pose estimate: the covariance has the eigenvalue ",
          solver.eigenvalues().minCoeff(), "; must be positive semi-definite");
}

Eigen::Matrix<double, 6, Eigen::Dynamic> root_of_variances(const Mat6& covariance) {
  // Scaled to a unit diagonal first: metres and radians have nothing to do with each other.
  Vec6 deviations = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Vec6 inverse = deviations.unaryExpr([](double d) { return d > 0 ? 1 / d : 0; });
  const Mat6 correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(correlation);
  Eigen::Matrix<double, 6, Eigen::Dynamic> root(6, 6);
  Eigen::Index count = 0;
  for (int k = 0; k < 6; ++k) {
    if (solver.eigenvalues()[k] > 1e-9) {
      root.col(count++) = deviations.asDiagonal() * solver.eigenvectors().col(k) * std::sqrt(solver.eigenvalues()[k]);
    }
  }
  return root.leftCols(count);
}

Mat6 inverse_covariance(const Mat6& covariance) {
  // Deviations below count as these, so that the inverse exists.
  constexpr double certain_position = 1e-6;     // metres
  constexpr double certain_orientation = 1e-6;  // radians
  Vec6 least;
  least << Vec3::Constant(certain_position * certain_position),
      Vec3::Constant(certain_orientation * certain_orientation);
  const Vec6 deviations = (covariance.diagonal() + least).cwiseSqrt();
  const Vec6 inverse = deviations.cwiseInverse();
  // Scaled to a unit diagonal first: metres and radians have nothing to do with each other.
  const Mat6 correlation = inverse.asDiagonal() * (covariance + Mat6(least.asDiagonal())) * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(correlation);
  const Vec6 of_values = solver.eigenvalues().cwiseMax(1e-9).cwiseInverse();
  const Mat6 inverse_correlation = solver.eigenvectors() * of_values.asDiagonal() * solver.eigenvectors().transpose();
  return inverse.asDiagonal() * inverse_correlation * inverse.asDiagonal();
}

double chi_squared_limit(int degrees_of_freedom) {
  constexpr double limits[] = {10.828, 13.816, 16.266, 18.467, 20.515, 22.458};
  require(degrees_of_freedom >= 1 && degrees_of_freedom <= 6, "chi-squared limit: ", degrees_of_freedom,
          " degrees of freedom; must be 1 to 6");
  return limits[degrees_of_freedom - 1];
}

}  // namespace vantage
