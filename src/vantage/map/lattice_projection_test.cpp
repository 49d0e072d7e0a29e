#include "vantage/map/lattice_projection.hpp"

#include <gtest/gtest.h>

#include "support/random_scenes.hpp"
#include "vantage/map/block_pixels.hpp"
#include "vantage/map/voxel_ray.hpp"

namespace vantage {
namespace {

using Kind = LatticeProjection::Footprint::Kind;

bool holds(const PixelRect& rect, int column, int row) {
  return column >= rect.left && column <= rect.right && row >= rect.top && row <= rect.bottom;
}

/// A random view of a random map, its rays and the projection of its lattice.
struct Scene {
  explicit Scene(Random& random)
      : map(test::unmarked_map(random)),
        view(test::random_view(map, random, test::stands[random.index(4)])),
        camera(test::random_camera(map, view, random)) {
    camera.resolution = test::random_resolution(random);
    projection.prepare(map.grid(), map.enclosure(), camera, view);
  }

  [[nodiscard]] bool passes(int column, int row, const Index3& local) const {
    const RayGrid rays = camera.rays();
    const LatticeRay ray(map.grid(), view.position(),
                         ray_direction(view.world_from_sensor.linear(), rays.x(column), rays.y(row)));
    return passes_voxel(map.grid(), ray, local + map.enclosure().min, camera.min_depth, LatticeRay::never);
  }

  VoxelMap map;
  View view;
  RangeCamera camera;
  LatticeProjection projection;
};

TEST(LatticeProjection, FootprintsMissNoRayThatPasses) {
  Random random(71);
  int scenes = 0;
  int passes = 0;
  int bounded = 0;
  for (; scenes < 400; ++scenes) {
    const Scene scene(random);
    const Index3 size = scene.map.layout().size;
    for (int i = 0; i < 10; ++i) {
      const Index3 voxel(random.index(size.x()), random.index(size.y()), random.index(size.z()));
      const auto footprint = scene.projection.footprint(voxel, voxel + Index3::Ones());
      if (footprint.kind == Kind::bounded) ++bounded;
      for (int row = 0; row < scene.camera.resolution.rows; ++row) {
        for (int column = 0; column < scene.camera.resolution.columns; ++column) {
          if (!scene.passes(column, row, voxel)) continue;
          ASSERT_NE(footprint.kind, Kind::none) << "scene " << scenes;
          ASSERT_TRUE(holds(footprint.pixels, column, row)) << "scene " << scenes;
          ++passes;
        }
      }
    }
  }
  EXPECT_GT(passes, 10000);
  EXPECT_GT(bounded, 1000);
}

TEST(LatticeProjection, BlocksTellTheFootprintsOfTheirVoxelsAndDensePixelsPass) {
  Random random(72);
  int voxels = 0;
  int dense_voxels = 0;
  for (int scenes = 0; scenes < 1500; ++scenes) {
    Scene scene(random);
    scene.camera.resolution = {40 + random.index(100), 40 + random.index(100)};
    scene.projection.prepare(scene.map.grid(), scene.map.enclosure(), scene.camera, scene.view);
    const Index3 size = scene.map.layout().size;
    const Index3 low = (Index3(random.index(size.x()), random.index(size.y()), random.index(size.z())) / 4) * 4;
    const Index3 high = (low + Index3::Constant(BlockPixels::side)).cwiseMin(size);
    const auto footprint = scene.projection.footprint(low, high);
    if (footprint.kind != Kind::bounded) continue;
    const BlockPixels block(scene.projection, low, size, footprint);
    for (int z = low.z(); z < high.z(); ++z) {
      for (int y = low.y(); y < high.y(); ++y) {
        for (int x = low.x(); x < high.x(); ++x) {
          const Index3 voxel(x, y, z);
          const PixelRect rect = block.rect(voxel - low);
          const auto alone = scene.projection.footprint(voxel, voxel + Index3::Ones());
          ++voxels;
          if (alone.kind == Kind::bounded) {
            ASSERT_LE(std::abs(rect.left - alone.pixels.left), 1);  // rounding may differ next to a pixel
            ASSERT_LE(std::abs(rect.right - alone.pixels.right), 1);
            ASSERT_LE(std::abs(rect.top - alone.pixels.top), 1);
            ASSERT_LE(std::abs(rect.bottom - alone.pixels.bottom), 1);
          }
          if (!scene.projection.is_dense(footprint)) continue;
          const auto [column, row] = block.nearest_to_center(voxel - low);
          ASSERT_TRUE(scene.passes(column, row, voxel)) << "scene " << scenes;
          ++dense_voxels;
        }
      }
    }
  }
  EXPECT_GT(voxels, 10000);
  EXPECT_GT(dense_voxels, 1000);
}

TEST(LatticeProjection, HandComputedCorner) {
  // From (0,0,-1) along +z with 90 degrees in 4 columns: tangent 0.25 is column 2, since rays have -3/4 .. 3/4.
  View view;
  view.world_from_sensor.translation() = Vec3(0, 0, -1);
  const RangeCamera camera = camera_from_apertures(radians(90), radians(90), {4, 4});
  const Grid grid{Vec3(0, 0, 0), 0.25, Index3(4, 4, 4)};
  LatticeProjection projection;
  projection.prepare(grid, grid.all(), camera, view);
  const auto [u, v, w] = projection.corner(1, 3, 0);
  EXPECT_NEAR(w, 1, 1e-15);
  EXPECT_NEAR(u / w, 2, 1e-14);
  EXPECT_NEAR(v / w, 3, 1e-14);
  const auto footprint = projection.footprint({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(footprint.kind, Kind::bounded);
  EXPECT_NEAR(footprint.min_depth, 1, 1e-10);
  EXPECT_NEAR(footprint.max_depth, 1.25, 1e-10);
  EXPECT_EQ(footprint.pixels.left, 2);  // tangents 0 .. 1/4 are columns 1.5 .. 2
  EXPECT_EQ(footprint.pixels.right, 2);
}

}  // namespace
}  // namespace vantage
