#include "vantage/registration/unposed_scans.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "support/analytic_scan.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr SensorModel exact;

std::vector<View> ring(int count, double step) {
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    const double azimuth = 0.3 + step * i;
    views.push_back(view_towards({1.8 * std::cos(azimuth), 1.8 * std::sin(azimuth), 0.9}, Vec3::Zero()));
  }
  return views;
}

std::vector<ScanSurface> scans_of(const test::Solid& solid, const std::vector<View>& views) {
  const RangeCamera camera = camera_from_apertures(radians(34), radians(34), {128, 128});
  std::vector<ScanSurface> scans;
  for (const View& view : views) scans.push_back(scan_surface(test::scan_solid(solid, camera, view), exact));
  return scans;
}

TEST(UnposedScans, ARingAroundAShapeWithoutSymmetryIsFound) {
  const std::vector<View> views = ring(4, radians(35));
  const std::vector<UnposedScan> found = find_poses(scans_of(test::knobbly(0.8), views));
  int right = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!found[i].world_from_sensor) continue;
    ASSERT_TRUE(found[0].world_from_sensor);
    // The world is the frame of the first scan.
    const Pose truth = views[0].world_from_sensor.inverse() * views[i].world_from_sensor;
    EXPECT_LT((found[i].world_from_sensor->translation() - truth.translation()).norm(), 0.02) << i;
    EXPECT_LT(rotation_angle(found[i].world_from_sensor->linear(), truth.linear()), radians(1)) << i;
    ++right;
  }
  EXPECT_GE(right, 3);
}

TEST(UnposedScans, ASphereIsNotGuessed) {
  const std::vector<UnposedScan> found = find_poses(scans_of(test::sphere(Vec3::Zero(), 0.3), ring(2, radians(40))));
  EXPECT_NE(found[0].world_from_sensor.has_value(), found[1].world_from_sensor.has_value());
  const Registration& refused = (found[0].world_from_sensor ? found[1] : found[0]).found;
  EXPECT_FALSE(refused.succeeded()) << refused.explanation;
}

TEST(UnposedScans, TheSameBitsForAnyNumberOfThreads) {
  const std::vector<ScanSurface> scans = scans_of(test::knobbly(0.8), ring(2, radians(35)));
  std::vector<std::vector<UnposedScan>> results;
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(find_poses(scans));
  }
  for (std::size_t i = 0; i < scans.size(); ++i)
    EXPECT_EQ(results[0][i].found.world_from_sensor.matrix(), results[1][i].found.world_from_sensor.matrix());
}

TEST(UnposedScans, OptionsAreChecked) {
  AnywhereOptions too_much;
  too_much.least_overlap = 2;
  EXPECT_THROW((void)find_poses({}, too_much), InputError);
  EXPECT_TRUE(find_poses({}).empty());
}

}  // namespace
}  // namespace vantage
