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

}  // namespace vantage
