#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// A small motion about a centre, all in metres: translation, then rotation vector times a length. The same step in any
/// component moves points at that length from the centre about equally far.
struct MotionFrame {
  Vec3 center = Vec3::Zero();
  double length = 1;  // m

  [[nodiscard]] Pose motion(const Vec6& step) const;
  /// The step that leads from pose `from` to pose `to` (world from sensor), the inverse of motion().
  [[nodiscard]] Vec6 step(const Pose& from, const Pose& to) const;
};

/// A scan point and the plane of the model it should lie in, world frame.
struct PlanePair {
  Vec3 point;
  Vec3 target;
  Vec3 normal;
  double weight = 1;

  [[nodiscard]] double residual() const { return normal.dot(target - point); }
};

/// Point-to-plane least squares over pairs, divided by the sum of weights. Eigenvalues of `matrix` are then the mean
/// squares of the cosines with which the surface resists a motion: 0 = free, about 0.3 = held well.
struct NormalEquations {
  Mat6 matrix = Mat6::Zero();
  Vec6 right_side = Vec6::Zero();
  double weight = 0;
};

/// Sums over blocks of fixed size in a fixed order: the same bits for any number of threads.
[[nodiscard]] NormalEquations normal_equations(std::span<const PlanePair> pairs, const MotionFrame& frame);

/// A Gauss-Newton step that leaves alone what the data do not determine.
struct DeterminedStep {
  Vec6 step = Vec6::Zero();
  int undetermined_directions = 0;
};

/// How strongly a shape resists the motions that a smaller part of it leaves undetermined: the largest mean squared
/// cosine under `whole` among the undetermined eigenvectors of `part`; 0 where there are none.
[[nodiscard]] double resistance_to_undetermined(const NormalEquations& part, const NormalEquations& whole,
                                                double least_eigenvalue);

/// Solves for the step. Eigenvectors with an eigenvalue below `least_eigenvalue` are undetermined: among the steps
/// that fit the data equally, this is the one after which `from_believed + step` is smallest, rotation counting far
/// more than translation, so that a sphere keeps its orientation and a plane also its place along itself.
[[nodiscard]] DeterminedStep solve(const NormalEquations& equations, double least_eigenvalue,
                                   const Vec6& from_believed);

}  // namespace vantage
