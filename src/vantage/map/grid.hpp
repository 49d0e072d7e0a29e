#pragma once

#include <cmath>

#include "vantage/core/geometry.hpp"
#include "vantage/map/evidence.hpp"

namespace vantage {

/// The lattice of the scene and the one home of point-to-voxel arithmetic: voxel i covers
/// [min + i*length, min + (i+1)*length) on each axis. Indices outside 0..size-1 are meaningful: the lattice goes on.
struct Grid {
  Vec3 min = Vec3::Zero();  // corner of voxel (0,0,0), metres
  double length = 0.02;     // edge of a voxel, metres
  Index3 size = Index3::Zero();

  /// Position of lattice plane k on an axis: the lower face of voxel k. Every path computes it by this expression.
  [[nodiscard]] double plane(int axis, int k) const { return min[axis] + k * length; }
  [[nodiscard]] Vec3 corner(const Index3& index) const {
    return {plane(0, index.x()), plane(1, index.y()), plane(2, index.z())};
  }
  [[nodiscard]] Vec3 center(const Index3& index) const { return corner(index) + Vec3::Constant(0.5 * length); }
  [[nodiscard]] bool contains(const Index3& index) const {
    return (index.array() >= 0).all() && (index.array() < size.array()).all();
  }
  /// Indices end here: whatever lies farther out has this index, so that sums of three still fit in an int.
  static constexpr int farthest_index = 1 << 28;
  /// The voxel along one axis whose planes enclose the coordinate, exactly: plane(k) <= coordinate < plane(k+1).
  [[nodiscard]] int index_of(int axis, double coordinate) const {
    const double guess = std::floor((coordinate - min[axis]) / length);
    if (!(std::abs(guess) < farthest_index)) return coordinate < min[axis] ? -farthest_index : farthest_index;
    int k = static_cast<int>(guess);
    while (plane(axis, k) > coordinate) --k;  // rounding may put the quotient on the wrong side of a plane
    while (plane(axis, k + 1) <= coordinate) ++k;
    return k;
  }
  [[nodiscard]] Index3 index_of(const Vec3& point) const {
    return {index_of(0, point.x()), index_of(1, point.y()), index_of(2, point.z())};
  }
  /// The box of space that a block of voxels fills.
  [[nodiscard]] Box3 box(const IndexBox& block) const {
    return {corner(block.min), corner(block.max + Index3::Ones())};
  }
  [[nodiscard]] IndexBox all() const { return {Index3::Zero(), size - Index3::Ones()}; }
  /// Throws InputError naming the field.
  void validate() const;
};

/// A scene of `scene_size` voxels centred at `center` with the object enclosure in its middle.
struct SceneOptions {
  Vec3 center = Vec3::Zero();
  double voxel_length = 0.02;                    // metres
  Index3 scene_size = Index3::Constant(205);     // voxels
  Index3 enclosure_size = Index3::Constant(55);  // voxels; the parity of both sizes should agree
  MapRule rule = MapRule::paper;

  void validate() const;
  [[nodiscard]] Grid grid() const;
  [[nodiscard]] IndexBox enclosure() const;
};

}  // namespace vantage
