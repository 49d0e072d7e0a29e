#include "vantage/search/pose_samples.hpp"

namespace vantage {
namespace {

/// Columns of a root of the covariance along which the robot errs at all.
Eigen::MatrixXd erring_directions(const PoseError::Matrix& covariance) {
  const Eigen::MatrixXd root = root_of(covariance);
  const double least = 1e-9 * root.colwise().norm().maxCoeff();
  Eigen::MatrixXd kept(6, 6);
  int count = 0;
  for (int i = 0; i < 6; ++i) {
    if (root.col(i).norm() > least) kept.col(count++) = root.col(i);
  }
  return kept.leftCols(count);
}

}  // namespace

std::vector<PoseSample> pose_samples(const PoseError& error, int count) {
  const Eigen::MatrixXd directions = erring_directions(error.covariance);
  if (directions.cols() == 0) return {{error.mean, 1}};
  const Eigen::MatrixXd points = normal_points(static_cast<int>(directions.cols()), count);
  std::vector<PoseSample> samples;
  samples.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) samples.push_back({error.mean + directions * points.col(i), 1.0 / count});
  return samples;
}

}  // namespace vantage
