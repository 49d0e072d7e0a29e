#include "vantage/map/voxel_ray.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

// Half of the coordinates and directions sit on lattice planes or axes, where ties happen.
double awkward(Random& random, double scale) {
  const double value = random.uniform(-scale, scale);
  return random.uniform() < 0.5 ? value : std::round(value * 4) / 4;
}

TEST(VoxelRay, TraversalAndClosedFormAgree) {
  Random random(7);
  int passed = 0;
  for (int scene = 0; scene < 3000; ++scene) {
    const Grid grid{Vec3(-1, -1, -1), random.uniform() < 0.5 ? 0.25 : 0.23, Index3(8, 8, 8)};
    const IndexBox box{Index3(1, 0, 2), Index3(6, 7, 5)};
    const Vec3 origin(awkward(random, 3), awkward(random, 3), awkward(random, 3));
    const Vec3 target(awkward(random, 1), awkward(random, 1), awkward(random, 1));
    const bool aimed = random.uniform() < 0.8;
    Vec3 direction = aimed ? Vec3(target - origin) : target;
    if (direction.isZero(0)) direction = Vec3::UnitX();
    const double near = random.uniform() < 0.5 ? 0 : random.uniform(0, 2);
    const double far = near + random.uniform(0.1, 6);
    const LatticeRay ray(grid, origin, direction);
    std::vector<Index3> visited;
    visit_voxels(grid, box, ray, near, [&](const Index3& index, double entered) {
      if (entered > far) return false;
      visited.push_back(index);
      return true;
    });
    std::vector<Index3> expected;
    for (int z = box.min.z(); z <= box.max.z(); ++z) {
      for (int y = box.min.y(); y <= box.max.y(); ++y) {
        for (int x = box.min.x(); x <= box.max.x(); ++x) {
          if (passes_voxel(grid, ray, {x, y, z}, near, far)) expected.emplace_back(x, y, z);
        }
      }
    }
    ASSERT_EQ(visited.size(), expected.size()) << "scene " << scene;
    for (const Index3& index : visited) {
      ASSERT_TRUE(passes_voxel(grid, ray, index, near, far)) << "scene " << scene << ": " << index.transpose();
    }
    for (std::size_t i = 1; i < visited.size(); ++i) ASSERT_EQ((visited[i] - visited[i - 1]).cwiseAbs().sum(), 1);
    passed += static_cast<int>(visited.size());
  }
  EXPECT_GT(passed, 5000);
}

}  // namespace
}  // namespace vantage
