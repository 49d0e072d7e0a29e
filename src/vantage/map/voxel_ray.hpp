#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <limits>

#include "vantage/map/grid.hpp"

namespace vantage {

/// A ray in the lattice of a grid. The ray passes voxels in the order of its crossings with lattice planes; crossings
/// are ordered by (t, axis), so that where it meets an edge or a corner it crosses the x plane first, then y, then z.
/// That is the one tie rule of the project: a voxel is on the ray iff the last of its three entering crossings comes
/// before the first of its three leaving ones. t is in units of the direction's length (depth for the rays of a
/// camera).
struct LatticeRay {
  static constexpr double never = std::numeric_limits<double>::infinity();

  Vec3 origin;
  Vec3 direction;
  Vec3 inverse;               // 1/direction, 0 on axes along which the ray does not move
  std::array<int, 3> step{};  // -1, 0, +1
  Index3 origin_cell;

  LatticeRay(const Grid& grid, const Vec3& ray_origin, const Vec3& ray_direction)
      : LatticeRay(ray_origin, grid.index_of(ray_origin), ray_direction) {}
  /// For many rays from one place, whose voxel is known.
  LatticeRay(const Vec3& ray_origin, const Index3& cell_of_origin, const Vec3& ray_direction)
      : origin(ray_origin), direction(ray_direction), origin_cell(cell_of_origin) {
    for (int a = 0; a < 3; ++a) {
      const double reciprocal = 1 / direction[a];
      const bool moves = direction[a] != 0 && std::isfinite(reciprocal);
      inverse[a] = moves ? reciprocal : 0;
      step[static_cast<std::size_t>(a)] = !moves ? 0 : (direction[a] > 0 ? 1 : -1);
    }
  }

  [[nodiscard]] int step_along(int axis) const { return step[static_cast<std::size_t>(axis)]; }
  /// t of the crossing by which the ray enters slab k of an axis; every path computes it by this expression.
  [[nodiscard]] double enter(const Grid& grid, int axis, int k) const {
    return (grid.plane(axis, step_along(axis) > 0 ? k : k + 1) - origin[axis]) * inverse[axis];
  }
};

/// A crossing of a lattice plane. Crossings are ordered by (t, axis).
struct Crossing {
  double t;
  int axis;
  auto operator<=>(const Crossing&) const = default;
};

/// Calls `visit(index, t_enter, axis)` for every voxel of `box` that the ray passes with its leaving crossing after
/// `near`, in order, until `visit` returns false or the ray leaves the box. `t_enter` is the t by which the voxel was
/// entered (-infinity for the voxel that holds the origin); callers compare it with their far limit.
/// Amanatides and Woo's traversal with crossings computed afresh instead of summed up, so that nothing drifts.
template <class Visit>
void visit_voxels(const Grid& grid, const IndexBox& box, const LatticeRay& ray, double near, const Visit& visit) {
  constexpr int before_any_axis = 3;  // (t, 3) comes after all crossings at the same t
  Crossing start{near, before_any_axis};
  for (int a = 0; a < 3; ++a) {
    const int first = ray.step_along(a) > 0 ? box.min[a] : box.max[a];
    const int distance = (first - ray.origin_cell[a]) * ray.step_along(a);
    if (ray.step_along(a) == 0) {
      if (ray.origin_cell[a] < box.min[a] || ray.origin_cell[a] > box.max[a]) return;
    } else if (distance > 0) {
      const Crossing entry{ray.enter(grid, a, first), a};
      if (entry > start) start = entry;
    }
  }
  if (!(start.t < LatticeRay::never)) return;

  Index3 index = ray.origin_cell;
  std::array<Crossing, 3> next{};
  for (int a = 0; a < 3; ++a) {
    const int step = ray.step_along(a);
    if (step == 0) {
      next[static_cast<std::size_t>(a)] = {LatticeRay::never, a};
      continue;
    }
    // All crossings up to `start` have happened. Guess the slab, then correct the guess by the crossings themselves.
    const double guess = std::floor((ray.origin[a] + start.t * ray.direction[a] - grid.min[a]) / grid.length);
    int k = static_cast<int>(std::clamp(guess, box.min[a] - 1.0, box.max[a] + 1.0));
    if ((k - ray.origin_cell[a]) * step < 0) k = ray.origin_cell[a];
    const int last = step > 0 ? box.max[a] : box.min[a];
    while (k != ray.origin_cell[a] && Crossing{ray.enter(grid, a, k), a} > start) k -= step;
    while ((last - k) * step >= 0 && Crossing{ray.enter(grid, a, k + step), a} <= start) k += step;
    if (k < box.min[a] || k > box.max[a]) return;
    index[a] = k;
    next[static_cast<std::size_t>(a)] = {ray.enter(grid, a, k + step), a};
  }

  double entered = -LatticeRay::never;
  for (int a = 0; a < 3; ++a) {
    if (index[a] != ray.origin_cell[a]) entered = std::max(entered, ray.enter(grid, a, index[a]));
  }
  while (true) {
    if (!visit(index, entered)) return;
    int axis = next[0].t <= next[1].t ? 0 : 1;
    if (next[2].t < next[static_cast<std::size_t>(axis)].t) axis = 2;
    Crossing& crossing = next[static_cast<std::size_t>(axis)];
    if (!(crossing.t < LatticeRay::never)) return;
    const int step = ray.step_along(axis);
    index[axis] += step;
    if (index[axis] < box.min[axis] || index[axis] > box.max[axis]) return;
    entered = crossing.t;
    crossing.t = ray.enter(grid, axis, index[axis] + step);
  }
}

/// The tie rule in closed form for one voxel: does the ray pass it between `near` and `far`? Agrees with visit_voxels.
[[nodiscard]] bool passes_voxel(const Grid& grid, const LatticeRay& ray, const Index3& index, double near, double far);

/// A distance from `eye` at which every ray has left the box, and has taken more than steps_looked_through steps since.
[[nodiscard]] double distance_beyond(const Grid& grid, const IndexBox& box, const Vec3& eye);

/// Crossings of lattice planes on a ray up to `far`: the steps from the voxel of its origin to the one that it ends in.
[[nodiscard]] std::int64_t crossings_until(const Grid& grid, const LatticeRay& ray, double far);

/// Bresenham's line along its longest axis; see visit_bresenham.
template <int main, class Visit>
void visit_bresenham_along(const Index3& from, const Index3& to, const Visit& visit) {
  constexpr int u = (main + 1) % 3;
  constexpr int v = (main + 2) % 3;
  const Index3 delta = (to - from).cwiseAbs();
  const Index3 step = (to - from).cwiseSign();
  int error_u = 2 * delta[u] - delta[main];
  int error_v = 2 * delta[v] - delta[main];
  Index3 index = from;
  for (int i = 0; i <= delta[main]; ++i) {
    if (!visit(index)) return;
    if (error_u > 0) {
      index[u] += step[u];
      error_u -= 2 * delta[main];
    }
    if (error_v > 0) {
      index[v] += step[v];
      error_v -= 2 * delta[main];
    }
    error_u += 2 * delta[u];
    error_v += 2 * delta[v];
    index[main] += step[main];
  }
}

/// Bresenham's line in three dimensions from voxel `from` to voxel `to`, both included (the paper's ray tracing). Calls
/// `visit(index)` until it returns false.
template <class Visit>
void visit_bresenham(const Index3& from, const Index3& to, const Visit& visit) {
  int main = 0;
  (to - from).cwiseAbs().maxCoeff(&main);
  if (main == 0) visit_bresenham_along<0>(from, to, visit);
  if (main == 1) visit_bresenham_along<1>(from, to, visit);
  if (main == 2) visit_bresenham_along<2>(from, to, visit);
}

}  // namespace vantage
