#include "vantage/model/scan_cleaner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

/// A wall 1.5 m away with one pixel far before it.
Scan wall_with_a_stray_pixel(double sigma, std::uint64_t seed) {
  Random random(seed);
  RangeImage image{camera_from_apertures(radians(45), radians(45), {100, 100}), {}};
  for (int i = 0; i < 10000; ++i) image.depth.push_back(static_cast<float>(1.5 + sigma * random.normal()));
  image.depth[50 * 100 + 50] = 1;
  return scan_of(std::move(image));
}

TEST(ScanCleaner, EstimatesTheSensorAndTakesOutFlyingPixels) {
  ScanCleaner cleaner{SensorOptions{}};
  EXPECT_FALSE(cleaner.is_given());
  EXPECT_FALSE(cleaner.sensor());
  const ScanCleaner::Result result = cleaner.clean(wall_with_a_stray_pixel(0.004, 1));
  ASSERT_TRUE(cleaner.sensor());
  EXPECT_NEAR(cleaner.sensor()->noise(1.5), 0.004, 0.0004);
  ASSERT_TRUE(result.scan);
  EXPECT_GE(result.flying, 1);
  EXPECT_LE(result.flying, 5);
  const auto& image = std::get<ImageScan>(*result.scan);
  EXPECT_EQ(image.image.at(50, 50), RangeImage::unknown);
  EXPECT_EQ(image.normals[50 * 100 + 50], Vec3f::Zero());
}

TEST(ScanCleaner, GivenSensorsStayAsTheyAre) {
  ScanCleaner cleaner{SensorOptions{.sensor = "primesense", .depth_noise = DepthDeviation{0.01, 0}}};
  EXPECT_TRUE(cleaner.is_given());
  (void)cleaner.clean(wall_with_a_stray_pixel(0.001, 2));
  EXPECT_EQ(cleaner.sensor()->noise(1.5), 0.01);
  EXPECT_EQ(cleaner.sensor()->lateral, 0.8);
}

TEST(ScanCleaner, LeavesScansAloneWhereAskedToAndClouds) {
  ScanCleaner keeper{SensorOptions{.flying_pixels = FlyingPixelRule::keep}};
  EXPECT_FALSE(keeper.clean(wall_with_a_stray_pixel(0.001, 3)).scan);
  ScanCleaner cleaner{SensorOptions{}};
  EXPECT_FALSE(cleaner.clean(PointScan{{Vec3(0, 0, 1)}, {}, {Vec3::Zero()}}).scan);
}

TEST(SensorOptions, NamesWhatIsWrong) {
  const auto complaint = [](const SensorOptions& options) -> std::string {
    try {
      options.validate();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(complaint({}), "nothing was thrown");
  EXPECT_THAT(complaint({.sensor = "lidar"}), HasSubstr("sensor = 'lidar': must be one of: ideal, primesense"));
  EXPECT_THAT(complaint({.depth_noise = DepthDeviation{-1, 0}}),
              HasSubstr("depth-noise = -1,0,0: must be from 0 to 1000000"));
}

}  // namespace
}  // namespace vantage
