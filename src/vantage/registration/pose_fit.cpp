#include "vantage/registration/pose_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vantage {
SurfacePair surface_pair(const SurfaceSample& scan, const SurfaceSample& model, double floor) {
  return {.point = scan.point,
          .target = model.point,
          .normal = (scan.normal + model.normal).normalized(),
          .scan_normal = scan.normal,
          .model_normal = model.normal,
          .variance = scan.sigma * scan.sigma + model.sigma * model.sigma + floor};
}

void Information::add(const SurfacePair& pair, const Vec3& sensor_position, double spread) {
  const double variance = pair.variance + spread * spread;
  const double residual = pair.residual();
  // Geman and McClure's kernel: full weight within a standard deviation, a quarter at two, next to none beyond six.
  const double excess = 1 + residual * residual / (4 * variance);
  const double weight = 1 / (variance * excess * excess);
  const Vec3 arm = pair.point - sensor_position;
  Vec6 row, scan_row, model_row;
  row << pair.normal, arm.cross(pair.normal);
  scan_row << pair.scan_normal, arm.cross(pair.scan_normal);
  model_row << pair.model_normal, arm.cross(pair.model_normal);
  matrix.noalias() += (weight * row) * row.transpose();
  side += weight * residual * row;
  agreed.noalias() += (weight / 2 * model_row) * scan_row.transpose();
  agreed.noalias() += (weight / 2 * scan_row) * model_row.transpose();
  ++pairs;
}

Information information(std::span<const SurfacePair> pairs, const Vec3& sensor_position, double spread) {
  Information sum;
  for (const SurfacePair& pair : pairs) sum.add(pair, sensor_position, spread);
  return sum;
}

Eigen::VectorXd searching_step(const WhitenedPrior& prior, const Information& pairs, const Eigen::VectorXd& u) {
  const auto d = prior.dimensions();
  const Eigen::MatrixXd matrix =
      prior.root().transpose() * pairs.matrix * prior.root() + Eigen::MatrixXd::Identity(d, d);
  return matrix.ldlt().solve(prior.root().transpose() * pairs.side - u);
}

PoseAxes pose_axes(const WhitenedPrior& prior, const Information& pairs, double shared_error) {
  const auto d = prior.dimensions();
  if (d == 0) return {};
  const Eigen::MatrixXd known = prior.root().transpose() * pairs.matrix * prior.root();
  const Eigen::MatrixXd agreed = prior.root().transpose() * pairs.agreed * prior.root();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(known);
  PoseAxes axes{Eigen::MatrixXd(d, d), Eigen::MatrixXd(d, d)};
  // In the direction that is known best nearly all pairs take part: that tells what a single one is worth.
  const double of_a_pair = solver.eigenvalues()[d - 1] / std::max(1, pairs.pairs);
  axes.shared_variance = of_a_pair > 0 ? shared_error * shared_error / of_a_pair : 0;
  Eigen::Index determined = 0, open = 0;
  for (Eigen::Index k = 0; k < d; ++k) {
    const Eigen::VectorXd direction = solver.eigenvectors().col(k);
    const double in_both = direction.dot(agreed * direction);
    // What the noise of normals adds to the sum of the pairs alone averages out in `agreed`, but for this much.
    const double noise = std::max(0.0, solver.eigenvalues()[k] - in_both) / std::sqrt(std::max(1, pairs.pairs));
    constexpr double significant = 5;  // standard deviations
    if (in_both >= significant * noise && in_both >= 1 + axes.shared_variance * in_both) {
      axes.determined.col(determined++) = direction;
    } else {
      axes.open.col(open++) = direction;
    }
  }
  axes.determined.conservativeResize(Eigen::NoChange, determined);
  axes.open.conservativeResize(Eigen::NoChange, open);
  return axes;
}

PosteriorStep posterior_step(const WhitenedPrior& prior, const Information& pairs, const Eigen::VectorXd& u,
                             const PoseAxes& axes) {
  const auto d = prior.dimensions();
  PosteriorStep result;
  result.step = Eigen::VectorXd::Zero(d);
  if (d == 0) return result;
  result.step = -axes.open * (axes.open.transpose() * u);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> stays = prior.root() * axes.open;
  result.covariance = stays * stays.transpose();
  if (axes.determined.cols() > 0) {
    // In the axes of what is known, in which errors that all pairs share are added to those that average out.
    const Eigen::MatrixXd first = prior.root() * axes.determined;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(first.transpose() * pairs.agreed * first);
    const Eigen::VectorXd information = solver.eigenvalues().cwiseMax(0);
    const Eigen::VectorXd worth = (1 + axes.shared_variance * information.array()).inverse();
    const Eigen::MatrixXd directions = axes.determined * solver.eigenvectors();
    const Eigen::Matrix<double, 6, Eigen::Dynamic> effects = prior.root() * directions;
    const Eigen::VectorXd side = worth.asDiagonal() * (effects.transpose() * pairs.side) - directions.transpose() * u;
    const Eigen::MatrixXd slope = worth.asDiagonal() * (effects.transpose() * pairs.matrix * effects) +
                                  Eigen::MatrixXd::Identity(directions.cols(), directions.cols());
    result.step += directions * slope.partialPivLu().solve(side);
    const Eigen::VectorXd known = worth.cwiseProduct(information);
    result.covariance += effects * (1 + known.array()).inverse().matrix().asDiagonal() * effects.transpose();
    // Where the prior is certain in some direction, what the pairs say of it does not matter.
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(prior.root()).completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::MatrixXd seen = directions.transpose() * inverse;
    result.information = seen.transpose() * known.asDiagonal() * seen;
  }
  result.covariance = 0.5 * (result.covariance + result.covariance.transpose()).eval();
  return result;
}

}  // namespace vantage
