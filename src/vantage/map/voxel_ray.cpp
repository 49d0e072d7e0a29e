#include "vantage/map/voxel_ray.hpp"

#include <algorithm>

namespace vantage {

bool passes_voxel(const Grid& grid, const LatticeRay& ray, const Index3& index, double near, double far) {
  Crossing entered{-LatticeRay::never, -1};
  Crossing left{LatticeRay::never, 3};
  for (int a = 0; a < 3; ++a) {
    const int step = ray.step_along(a);
    const int ahead = (index[a] - ray.origin_cell[a]) * step;
    if (ahead < 0 || (step == 0 && index[a] != ray.origin_cell[a])) return false;
    if (step == 0) continue;
    if (ahead > 0) entered = std::max(entered, Crossing{ray.enter(grid, a, index[a]), a});
    left = std::min(left, Crossing{ray.enter(grid, a, index[a] + step), a});
  }
  return entered < left && left.t > near && entered.t <= far;
}

double distance_beyond(const Grid& grid, const IndexBox& box, const Vec3& eye) {
  const Box3 space = grid.box(box);
  // Along each axis a ray may end just before its next crossing.
  constexpr int lengths = steps_looked_through + 4;
  return (space.center() - eye).norm() + 0.5 * space.diagonal().norm() + lengths * grid.length;
}

std::int64_t crossings_until(const Grid& grid, const LatticeRay& ray, double far) {
  std::int64_t crossings = 0;
  for (int a = 0; a < 3; ++a) {
    const int step = ray.step_along(a);
    if (step == 0) continue;
    const int cell = ray.origin_cell[a];
    int k = grid.index_of(a, ray.origin[a] + far * ray.direction[a]);
    if ((k - cell) * step < 0) k = cell;
    while (k != cell && ray.enter(grid, a, k) > far) k -= step;
    while (ray.enter(grid, a, k + step) <= far) k += step;
    crossings += std::abs(k - cell);
  }
  return crossings;
}

}  // namespace vantage
