#include "vantage/map/scan_limits.hpp"

#include <gtest/gtest.h>

#include "support/random_scenes.hpp"
#include "vantage/map/voxel_ray.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {
namespace {

TEST(StepCounts, CountPlanesFromTheEye) {
  const StepCounts outside(Index3(5, 6, 7), Index3(-3, 2, 10));
  EXPECT_EQ(outside.first, 3 + 0 + 4);
  EXPECT_EQ(outside.span, 7 + 3 + 10 - 7);
  EXPECT_EQ(outside.of({0, 2, 6}), 0);
  EXPECT_EQ(outside.of({4, 5, 0}), outside.span);
  const StepCounts inside(Index3(5, 5, 5), Index3(1, 2, 3));
  EXPECT_EQ(inside.first, 0);
  EXPECT_EQ(inside.span, 3 + 2 + 3);
}

TEST(StepCounts, RangeOfABlockHoldsItsVoxels) {
  Random random(81);
  for (int i = 0; i < 300; ++i) {
    const StepCounts steps(Index3(9, 9, 9), Index3(random.index(20) - 5, random.index(20) - 5, random.index(20) - 5));
    const Index3 low(random.index(9), random.index(9), random.index(9));
    const Index3 high = low + Index3(1 + random.index(4), 1 + random.index(4), 1 + random.index(4));
    int least = 1000;
    int most = -1000;
    for (int z = low.z(); z < high.z(); ++z) {
      for (int y = low.y(); y < high.y(); ++y) {
        for (int x = low.x(); x < high.x(); ++x) {
          least = std::min(least, steps.of({x, y, z}));
          most = std::max(most, steps.of({x, y, z}));
        }
      }
    }
    ASSERT_EQ(steps.range(low, high), std::pair(least, most));
  }
}

/// Random depths for a random view of a random map.
struct LimitsScene {
  explicit LimitsScene(Random& random)
      : map(test::unmarked_map(random)),
        view(test::random_view(map, random, test::stands[random.index(4)])),
        image{test::random_camera(map, view, random), {}},
        steps(map.layout().size, map.grid().index_of(view.position()) - map.enclosure().min) {
    image.camera.resolution = test::random_resolution(random);
    const double distance = (map.enclosure_center() - view.position()).norm();
    for (int i = 0; i < image.camera.resolution.rays(); ++i) {
      const double kind = random.uniform();
      const double depth = random.uniform() < 0.3
                               ? std::round(random.uniform(0.5, 1.5) * distance / map.grid().length) * map.grid().length
                               : random.uniform(0.01, 2) * distance;
      image.depth.push_back(kind < 0.2   ? RangeImage::unknown
                            : kind < 0.5 ? RangeImage::no_return
                                         : static_cast<float>(std::max(depth, 1e-3)));
    }
    limits.prepare(map, image, view, steps);
  }

  VoxelMap map;
  View view;
  RangeImage image;
  StepCounts steps;
  ScanLimits limits;
};

TEST(ScanLimits, SayOfEveryVoxelOnARayWhatTheTraversalSays) {
  Random random(82);
  int rays_checked = 0;
  int voxels = 0;
  int points = 0;
  for (int scenes = 0; scenes < 300; ++scenes) {
    const LimitsScene scene(random);
    const Grid& grid = scene.map.grid();
    const RayGrid rays = scene.image.camera.rays();
    std::vector<ScanPoint> found;
    for (const auto& band : scene.limits.points()) found.insert(found.end(), band.begin(), band.end());
    std::size_t next_point = 0;
    for (int row = 0; row < rays.resolution.rows; ++row) {
      for (int column = 0; column < rays.resolution.columns; ++column) {
        const float depth = scene.image.at(column, row);
        const auto [emptied_below, occluded_above] = scene.limits.at(column, row);
        const LatticeRay ray(grid, scene.view.position(),
                             ray_direction(scene.view.world_from_sensor.linear(), rays.x(column), rays.y(row)));
        const bool is_hit = RangeImage::is_hit(depth);
        const Index3 hit = grid.index_of(Vec3(ray.origin + static_cast<double>(depth) * ray.direction));
        const bool is_point = is_hit && scene.map.enclosure().contains(hit);
        const int steps_to_hit = scene.steps.of(hit - scene.map.enclosure().min);
        if (is_point) {
          ASSERT_LT(next_point, found.size());
          ASSERT_EQ(found[next_point].pixel, row * rays.resolution.columns + column);
          ASSERT_EQ(found[next_point].voxel, hit - scene.map.enclosure().min);
          ++next_point;
        }
        visit_voxels(grid, scene.map.enclosure(), ray, 0, [&](const Index3& voxel, double entered) {
          const int steps = scene.steps.of(voxel - scene.map.enclosure().min);
          const bool emptied = is_hit ? steps < steps_to_hit : depth > 0 && entered <= scene.image.camera.max_depth;
          EXPECT_EQ(steps < emptied_below, emptied) << "scene " << scenes;
          EXPECT_EQ(steps > occluded_above, is_point && steps > steps_to_hit) << "scene " << scenes;
          ++voxels;
          return true;
        });
        ++rays_checked;
      }
    }
    ASSERT_EQ(next_point, found.size());
    ASSERT_FALSE(HasFailure());
    points += static_cast<int>(found.size());
  }
  EXPECT_GT(rays_checked, 100000);
  EXPECT_GT(voxels, 100000);
  EXPECT_GT(points, 5000);
}

TEST(ScanLimits, RangesHoldTheirPixelsAndNoneFarAway) {
  Random random(83);
  int ranges = 0;
  for (int scenes = 0; scenes < 100; ++scenes) {
    const LimitsScene scene(random);
    const Resolution image = scene.image.camera.resolution;
    for (int i = 0; i < 20; ++i, ++ranges) {
      PixelRect rect{random.index(image.columns), 0, random.index(image.rows), 0};
      rect.right = rect.left + random.index(image.columns - rect.left);
      rect.bottom = rect.top + random.index(image.rows - rect.top);
      const LimitRange range = scene.limits.range(rect);
      // Tiles are at least 4 pixels wide and never wider than the rectangle, else.
      const int reach = std::max({4, rect.right - rect.left + 1, rect.bottom - rect.top + 1});
      int least = 32767, most = -32768, least_nearby = 32767, most_nearby = -32768;
      for (int row = 0; row < image.rows; ++row) {
        for (int column = 0; column < image.columns; ++column) {
          const int emptied = scene.limits.at(column, row).emptied_below;
          const bool nearby = column > rect.left - reach && column < rect.right + reach && row > rect.top - reach &&
                              row < rect.bottom + reach;
          const bool inside = column >= rect.left && column <= rect.right && row >= rect.top && row <= rect.bottom;
          if (nearby) least_nearby = std::min(least_nearby, emptied), most_nearby = std::max(most_nearby, emptied);
          if (inside) least = std::min(least, emptied), most = std::max(most, emptied);
        }
      }
      ASSERT_LE(range.least_emptied(), least);
      ASSERT_GE(range.most_emptied(), most);
      ASSERT_GE(range.least_emptied(), least_nearby);
      ASSERT_LE(range.most_emptied(), most_nearby);
    }
  }
  EXPECT_EQ(ranges, 2000);
}

}  // namespace
}  // namespace vantage
