#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
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
  Vec3 normal;       // of the model
  Vec3 scan_normal;  // of the scan at the point
  double weight = 1;

  [[nodiscard]] double residual() const { return normal.dot(target - point); }
};

/// How far a unit step of each component moves a point along a normal.
[[nodiscard]] Vec6 effect_along(const Vec3& normal, const Vec3& point, const MotionFrame& frame);

/// Point-to-plane least squares over pairs, divided by the sum of weights.
struct NormalEquations {
  Mat6 matrix = Mat6::Zero();
  Vec6 right_side = Vec6::Zero();
  /// As `matrix`, but from products of model and scan normals. Noise of the normals feigns resistance in `matrix` where
  /// there is none; it is independent in model and scan and averages out here.
  Mat6 resistance = Mat6::Zero();
  double weight = 0;
};

/// Sums over blocks of fixed size in a fixed order: the same bits for any number of threads.
[[nodiscard]] NormalEquations normal_equations(std::span<const PlanePair> pairs, const MotionFrame& frame);

/// Motions sorted into those that the pairs determine and those that they leave open.
class Directions {
 public:
  Mat6 vectors = Mat6::Identity();  // columns: orthonormal steps
  std::array<bool, 6> is_open{};

  [[nodiscard]] int open_count() const { return static_cast<int>(std::count(is_open.begin(), is_open.end(), true)); }
  /// Those of `vectors` that are open, or that are determined.
  [[nodiscard]] Eigen::Matrix<double, 6, Eigen::Dynamic> open() const { return columns(true); }
  [[nodiscard]] Eigen::Matrix<double, 6, Eigen::Dynamic> determined() const { return columns(false); }

 private:
  [[nodiscard]] Eigen::Matrix<double, 6, Eigen::Dynamic> columns(bool wanted) const;
};

/// A direction is open where the surface resists the motion with a mean squared cosine below `least_resistance`.
[[nodiscard]] Directions directions(const NormalEquations& equations, double least_resistance);

/// Prices of the components of a motion by which open directions are settled: any rotation costs far more than any
/// shift.
[[nodiscard]] Vec6 rotation_averse_cost();

/// The Gauss-Newton step in the determined directions. Of all steps that fit the data equally it is the one after which
/// `from_believed + step` is smallest, rotation counting far more than translation, so that a sphere keeps its
/// orientation and a plane also its place along itself.
[[nodiscard]] Vec6 solve(const NormalEquations& equations, const Directions& directions, const Vec6& from_believed,
                         const Vec6& cost = rotation_averse_cost());

}  // namespace vantage
