#include "vantage/sensor/sight_line.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double tiny = 1e-14;

/// 90 degrees, 2x1 pixels: tangents -1/2 and 1/2. From (0,0,2) straight down: right is +x, down is -y.
RangeImage two_pixels(float left, float right) {
  RangeImage image;
  image.camera = camera_from_apertures(radians(90), radians(90), {2, 1});
  image.camera.max_depth = 3;
  image.depth = {left, right};
  return image;
}

const View from_above = view_towards({0, 0, 2}, Vec3::Zero());

TEST(SightLines, HitsNoReturnsAndUnknownPixels) {
  const std::vector<SightLine> lines = sight_lines(two_pixels(2, RangeImage::no_return), {}, from_above);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines[0].is_hit);
  EXPECT_LT((lines[0].hit_point() - Vec3(-1, 0, 0)).norm(), tiny);
  EXPECT_EQ(lines[0].normal, Vec3::Zero());
  EXPECT_EQ(lines[0].quality, 0);
  EXPECT_FALSE(lines[1].is_hit);
  EXPECT_EQ(lines[1].end, 3);
  EXPECT_TRUE(sight_lines(two_pixels(0, 0), {}, from_above).empty());
}

TEST(SightLines, AHitBeyondTheFarLimitIsStillAHit) {
  const std::vector<SightLine> lines = sight_lines(two_pixels(5, 0), {}, from_above);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].is_hit);
  EXPECT_EQ(lines[0].end, 5);
}

TEST(SightLines, QualityIsAgainstTheAxisOrTheRay) {
  // The surface faces straight up; the ray leans by atan(1/2).
  const std::vector<Vec3f> normals(2, Vec3f(0, 0, -1));
  const RangeImage image = two_pixels(2, 2);
  const SightLine to_axis = sight_lines(image, normals, from_above)[0];
  EXPECT_LT((to_axis.normal - Vec3::UnitZ()).norm(), tiny);
  EXPECT_NEAR(to_axis.quality, 1, tiny);
  EXPECT_NEAR(sight_lines(image, normals, from_above, QualityReference::ray)[0].quality, 2 / std::sqrt(5.0), tiny);
}

TEST(SightLines, QualityIsNeverNegative) {
  const std::vector<Vec3f> normals(2, Vec3f(0, 0, 1));
  EXPECT_EQ(sight_lines(two_pixels(2, 2), normals, from_above)[0].quality, 0);
}

TEST(SightLines, SizesMustAgree) {
  EXPECT_THROW((void)sight_lines(two_pixels(2, 2), std::vector<Vec3f>(3), from_above), InputError);
  RangeImage image = two_pixels(2, 2);
  image.depth.pop_back();
  EXPECT_THROW((void)sight_lines(image, {}, from_above), InputError);
}

TEST(SightLines, PointScanWithOneOriginOrOnePerPoint) {
  PointScan scan;
  scan.points = {{1, 0, 2}, {0, 0, 1}, {0, 0, 0}};
  scan.normals = {{0, 0, -1}, {0, 0, 0}, {0, 0, -1}};
  scan.origins = {{0, 0, 0}};
  const std::vector<SightLine> lines = sight_lines(scan, from_above);
  ASSERT_EQ(lines.size(), 2U) << "a point at its own origin says nothing";
  EXPECT_LT((lines[0].hit_point() - Vec3(1, 0, 0)).norm(), tiny);
  EXPECT_LT((lines[0].origin - Vec3(0, 0, 2)).norm(), tiny);
  EXPECT_NEAR(lines[0].quality, 1, tiny);
  EXPECT_NEAR(sight_lines(scan, from_above, QualityReference::ray)[0].quality, 2 / std::sqrt(5.0), tiny);
  EXPECT_EQ(lines[1].normal, Vec3::Zero());

  scan.origins = {{1, 0, 0}, {0, 0, 0}, {0, 0, -1}};
  EXPECT_EQ(sight_lines(scan, from_above).size(), 3U);
  EXPECT_LT((sight_lines(scan, from_above)[0].direction - Vec3(0, 0, -2)).norm(), tiny);
  scan.origins.pop_back();
  EXPECT_THROW((void)sight_lines(scan, from_above), InputError);
}

}  // namespace
}  // namespace vantage
