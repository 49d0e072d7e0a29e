#include "vantage/robot/clear_paths.hpp"

#include <gtest/gtest.h>

#include "support/random_scenes.hpp"
#include "vantage/robot/reach.hpp"

namespace vantage {
namespace {

VoxelMap tiny_unmarked_map() {
  SceneOptions scene;
  scene.scene_size = Index3::Constant(201);
  scene.enclosure_size = Index3::Constant(1);
  return VoxelMap(scene);
}

TEST(ClearPaths, GoesStraightWhereNothingIsInTheWay) {
  const VoxelMap map = tiny_unmarked_map();
  const ClearPaths space({map}, 0.1, std::nullopt);
  const auto way = space.path(Vec3(-1, 0.2, 0), Vec3(1, 0.2, 0));
  ASSERT_TRUE(way);
  EXPECT_EQ(way->size(), 2U);
  EXPECT_EQ(length_of(*way), 2);
}

TEST(ClearPaths, GoesAroundAWallAsAStringWould) {
  const VoxelMap map = tiny_unmarked_map();
  // A wall of 10 cm across the way, 1 m to the side where it ends first, and too high and deep to go over or under.
  const std::vector<Box3> wall{Box3(Vec3(-0.05, -9, -9), Vec3(0.05, 1, 9))};
  const double radius = 0.1;
  const ClearPaths space({map, wall}, radius, std::nullopt);
  const Vec3 from(-1.5, 0, 0);
  const auto way = space.path(from, Vec3(1.5, 0, 0));
  ASSERT_TRUE(way);
  // A string around a cylinder of the ball's radius at each of the wall's two edges: tangent, arc, straight piece.
  const double to_edge = Vec3(1.45, 1, 0).norm();
  const double tangent = std::sqrt(to_edge * to_edge - radius * radius);
  const double arc = radius * (std::atan2(1.0, 1.45) + std::asin(radius / to_edge));
  const double shortest = 2 * (tangent + arc) + 0.1;
  EXPECT_GE(length_of(*way), shortest);
  EXPECT_LT(length_of(*way), 1.03 * shortest);
}

TEST(ClearPaths, FindsNoWayOutOfAClosedRoomNorOutOfTheWorkspace) {
  const VoxelMap map = tiny_unmarked_map();
  std::vector<Box3> room;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 low = Vec3::Constant(-1.1), high = Vec3::Constant(1.1);
      low[axis] = side - 0.05;
      high[axis] = side + 0.05;
      room.emplace_back(low, high);
    }
  }
  EXPECT_FALSE(ClearPaths({map, room}, 0.05, std::nullopt).path(Vec3(0.5, 0, 0), Vec3(1.5, 0, 0)));
  room.pop_back();
  EXPECT_TRUE(ClearPaths({map, room}, 0.05, std::nullopt).path(Vec3(0.5, 0, 0), Vec3(1.5, 0, 0)));
  const Box3 workspace(Vec3::Constant(-1.5), Vec3(1.5, 1.5, 0.9));  // the opening is above it
  EXPECT_FALSE(ClearPaths({map, room}, 0.05, workspace).path(Vec3(0.5, 0, 0), Vec3(1.4, 0, 0)));
}

TEST(ClearPaths, WaysTouchNothingAndAreNoShorterThanTheStraightLine) {
  Random random(21);
  int direct = 0, around = 0, none = 0;
  std::int64_t places = 0;
  for (int scene = 0; scene < 80; ++scene) {
    VoxelMap map = test::unmarked_map(random);
    if (scene % 4 != 0) test::fill_with_blobs(map, random);
    const Box3 box = map.grid().box(map.enclosure());
    ReachOptions reach;
    reach.body_radius = random.uniform(0, 0.3) * box.sizes().maxCoeff();
    const ClearPaths space({map}, reach.body_radius, std::nullopt);
    for (int i = 0; i < 6; ++i) {
      const Vec3 from = box.center() + box.diagonal().norm() * random.unit_vector();
      const Vec3 to = box.center() + random.uniform(0.2, 1) * box.diagonal().norm() * random.unit_vector();
      const auto way = space.path(from, to);
      if (!way) {
        ++none;
        continue;
      }
      (way->size() == 2 ? direct : around) += 1;
      EXPECT_EQ(way->front(), from);
      EXPECT_EQ(way->back(), to);
      EXPECT_GE(length_of(*way), (to - from).norm() * (1 - 1e-12));
      for (std::size_t k = 1; k < way->size(); ++k) {
        for (int step = 0; step <= 100; ++step, ++places) {
          const Vec3 at = (*way)[k - 1] + step / 100.0 * ((*way)[k] - (*way)[k - 1]);
          View view;
          view.world_from_sensor.translation() = at;
          const auto reason = why_infeasible(map, view, reach);
          ASSERT_FALSE(reason) << *reason;
        }
      }
    }
  }
  EXPECT_GT(direct, 50);
  EXPECT_GT(around, 50);
  EXPECT_GT(none, 20);
  EXPECT_GT(places, 20000);
}

}  // namespace
}  // namespace vantage
