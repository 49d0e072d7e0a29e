#include "vantage/registration/free_space.hpp"

#include <gtest/gtest.h>

#include "support/analytic_scan.hpp"

namespace vantage {
namespace {

TEST(FreeSpace, HoldsWhatTheSensorLookedThroughAndKeepsItsMargin) {
  // A wall at z = 2 (sensor frame) on the right half of the image, nothing on the left.
  const RangeCamera camera = camera_from_apertures(radians(60), radians(60), {200, 200});
  RangeImage image{camera, std::vector<float>(200 * 200, RangeImage::no_return)};
  for (std::size_t row = 0; row < 200; ++row) {
    for (std::size_t column = 100; column < 200; ++column) image.depth[row * 200 + column] = 2;
  }
  const FreeSpace space(image, SensorModel{.constant = 0.02}, 0.1);
  EXPECT_TRUE(space.contains({0.5, 0, 1.5}));
  EXPECT_FALSE(space.contains({0.5, 0, 1.95}));   // closer to the wall than the margin
  EXPECT_FALSE(space.contains({0.5, 0, 2.5}));    // behind it
  EXPECT_TRUE(space.contains({-0.5, 0, 2.5}));    // nothing was met there
  EXPECT_FALSE(space.contains({-0.05, 0, 2.5}));  // beside the wall's edge, within the margin
  EXPECT_FALSE(space.contains({-0.5, 0, 4.6}));   // beyond the far limit
  EXPECT_FALSE(space.contains({0.5, 0, -1}));     // behind the sensor
  EXPECT_FALSE(space.contains({3, 0, 1.5}));      // outside the image
}

TEST(FreeSpace, SaysNothingWhereTheImageKnowsNothing) {
  const RangeCamera camera = camera_from_apertures(radians(60), radians(60), {100, 100});
  const RangeImage image{camera, std::vector<float>(100 * 100, RangeImage::unknown)};
  const FreeSpace space(image, SensorModel{.constant = 0.02}, 0.1);
  EXPECT_FALSE(space.contains({0, 0, 1}));
}

TEST(FreeSpace, NoPointOfTheScannedSurfaceIsFree) {
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {160, 160});
  const test::Solid solid = test::knobbly(0.8);
  const View one = view_towards({0.8, 1.5, 1}, Vec3::Zero()), other = view_towards({1.6, 0.4, 1}, Vec3::Zero());
  const FreeSpace space(test::scan_solid(solid, camera, one), SensorModel{.constant = 0.01}, 0.05);
  const RangeImage image = test::scan_solid(solid, camera, other);
  std::vector<Vec3> points;
  for (int row = 0; row < 160; ++row) {
    for (int column = 0; column < 160; ++column) {
      if (!RangeImage::is_hit(image.at(column, row))) continue;
      points.push_back(other.world_from_sensor *
                       point_in_sensor(camera.rays(), column, row, static_cast<double>(image.at(column, row))));
    }
  }
  ASSERT_GT(points.size(), 1000U);
  const Pose sensor_from_world = one.world_from_sensor.inverse();
  for (const Vec3& point : points) EXPECT_FALSE(space.contains(sensor_from_world * point));
}

}  // namespace
}  // namespace vantage
