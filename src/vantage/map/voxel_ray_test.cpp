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

// Rays nearly parallel to a slab meet it astronomically far away; the traversal must neither overflow nor walk there.
TEST(VoxelRay, NearlyParallelRays) {
  const Grid grid{Vec3(-1, -1, -1), 0.25, Index3(8, 8, 8)};
  int hits = 0;
  for (const double tilt : {0.0, 1e-300, 1e-30, 1e-17, -1e-17, 1e-9}) {
    for (const double height : {-5.0, -1.0, 0.1, 5.0}) {
      for (const double along : {1.0, 1e-25}) {
        const LatticeRay ray(grid, Vec3(-3, 0.1, height), Vec3(along, 0, tilt));
        visit_voxels(grid, grid.all(), ray, 0, [&](const Index3& index, double) {
          EXPECT_TRUE(passes_voxel(grid, ray, index, 0, LatticeRay::never));
          ++hits;
          return true;
        });
      }
    }
  }
  EXPECT_GT(hits, 8 * 6);
}

std::vector<std::pair<int, int>> bresenham_in_plane(const Index3& to) {
  std::vector<std::pair<int, int>> visited;
  visit_bresenham(Index3::Zero(), to, [&](const Index3& index) {
    visited.emplace_back(index.x(), index.y());
    return true;
  });
  return visited;
}

// y = 2x/5 drawn on squared paper: 0, 0.4, 0.8, 1.2, 1.6, 2 rounds to 0, 0, 1, 1, 2, 2.
TEST(Bresenham, HandDrawnLine) {
  using Line = std::vector<std::pair<int, int>>;
  EXPECT_EQ(bresenham_in_plane({5, 2, 0}), (Line{{0, 0}, {1, 0}, {2, 1}, {3, 1}, {4, 2}, {5, 2}}));
  EXPECT_EQ(bresenham_in_plane({-2, 5, 0}), (Line{{0, 0}, {0, 1}, {-1, 2}, {-1, 3}, {-2, 4}, {-2, 5}}));
  EXPECT_EQ(bresenham_in_plane({0, 0, 0}), (Line{{0, 0}}));
}

TEST(Bresenham, EveryVoxelIsTheNearestToTheLineAlongTheMainAxis) {
  Random random(8);
  int lines = 0;
  for (int i = 0; i < 500; ++i) {
    const Index3 from(random.index(50) - 25, random.index(50) - 25, random.index(50) - 25);
    const Index3 to(random.index(50) - 25, random.index(50) - 25, random.index(50) - 25);
    std::vector<Index3> visited;
    visit_bresenham(from, to, [&](const Index3& index) {
      visited.push_back(index);
      return true;
    });
    const int steps = (to - from).cwiseAbs().maxCoeff();
    ASSERT_EQ(visited.size(), static_cast<std::size_t>(steps + 1));
    ASSERT_EQ(visited.front(), from);
    ASSERT_EQ(visited.back(), to);
    for (int k = 0; k <= steps && steps > 0; ++k) {
      const Vec3 exact = from.cast<double>() + (to - from).cast<double>() * k / steps;
      ASSERT_LE((visited[static_cast<std::size_t>(k)].cast<double>() - exact).cwiseAbs().maxCoeff(), 0.5 + 1e-12);
    }
    ++lines;
  }
  EXPECT_EQ(lines, 500);
}

TEST(Bresenham, StopsWhenAsked) {
  int visited = 0;
  visit_bresenham(Index3::Zero(), Index3(9, 3, 1), [&](const Index3&) { return ++visited < 4; });
  EXPECT_EQ(visited, 4);
}

}  // namespace
}  // namespace vantage
