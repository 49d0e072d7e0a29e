#include "vantage/sensor/range_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

RangeCamera square_camera(double aperture_degrees, int side) {
  return camera_from_apertures(radians(aperture_degrees), radians(aperture_degrees), {side, side});
}

TEST(RangeCamera, DefaultIsThePapersSensor) {
  const RangeCamera camera;
  EXPECT_NEAR(degrees(camera.horizontal_aperture()), 45, 1e-12);
  EXPECT_NEAR(degrees(camera.vertical_aperture()), 45, 1e-12);
  EXPECT_NO_THROW(camera.validate());
}

TEST(RangeCamera, RaysGoThroughPixelCentres) {
  // 90 degrees in 4 columns: tangents -3/4, -1/4, 1/4, 3/4; 2 rows: -1/2, 1/2.
  const RayGrid rays = camera_from_apertures(radians(90), radians(90), {4, 2}).rays();
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(rays.x(i), -0.75 + 0.5 * i, 1e-15);
  for (int j = 0; j < 2; ++j) EXPECT_NEAR(rays.y(j), -0.5 + j, 1e-15);
}

TEST(RangeCamera, AnOddGridHasARayOnTheAxis) {
  const RayGrid rays = square_camera(45, 79).rays();
  EXPECT_EQ(rays.x(39), 0);
  EXPECT_EQ(rays.y(39), 0);
  EXPECT_EQ(rays.x(0), -rays.x(78));
}

TEST(RangeCamera, IntrinsicsPutPixelCentresAtWholeNumbers) {
  const RangeCamera camera = camera_from_intrinsics(500, 510, 310.5, 250.25, {640, 480});
  const RayGrid rays = camera.rays();
  for (const int i : {0, 17, 310, 639}) EXPECT_NEAR(rays.x(i), (i - 310.5) / 500, 1e-14);
  for (const int j : {0, 99, 479}) EXPECT_NEAR(rays.y(j), (j - 250.25) / 510, 1e-14);
  EXPECT_NEAR(camera.horizontal_aperture(), std::atan(311 / 500.0) + std::atan(329 / 500.0), 1e-14);
}

TEST(RangeCamera, ErrorsNameTheField) {
  const auto broken = [](auto change) {
    RangeCamera camera;
    change(camera);
    return [camera] { camera.validate(); };
  };
  using Camera = RangeCamera;
  EXPECT_THAT(broken([](Camera& c) {
                c.resolution = {0, 5};
              }),
              ThrowsMessage<InputError>(HasSubstr("resolution = 0x5")));
  EXPECT_THAT(broken([](Camera& c) { c.resolution = {20000, 5}; }), ThrowsMessage<InputError>(HasSubstr("16384")));
  EXPECT_THAT(broken([](Camera& c) { c.left = c.right; }), ThrowsMessage<InputError>(HasSubstr("field of view")));
  EXPECT_THAT(broken([](Camera& c) { c.top = NAN; }), ThrowsMessage<InputError>(HasSubstr("finite")));
  EXPECT_THAT(broken([](Camera& c) { c.min_depth = -1; }), ThrowsMessage<InputError>(HasSubstr("min_depth = -1")));
  EXPECT_THAT(broken([](Camera& c) { c.max_depth = 0; }), ThrowsMessage<InputError>(HasSubstr("max_depth = 0")));
  EXPECT_THAT(broken([](Camera& c) { c.max_depth = NAN; }), ThrowsMessage<InputError>(HasSubstr("max_depth")));
  EXPECT_THAT(broken([](Camera& c) { c.max_incidence = 2; }), ThrowsMessage<InputError>(HasSubstr("(0, 90]")));
}

TEST(RangeCamera, AperturesMustLieBetween0And180Degrees) {
  for (const double bad : {0.0, -45.0, 180.0, 200.0}) {
    EXPECT_THAT([=] { (void)square_camera(bad, 10); }, ThrowsMessage<InputError>(HasSubstr("less than 180"))) << bad;
  }
  EXPECT_THROW((void)square_camera(std::nan(""), 10), InputError);
  EXPECT_NO_THROW((void)square_camera(179, 10));
}

TEST(RangeCamera, IntrinsicsMustFitTheImage) {
  EXPECT_THAT(
      [] {
        (void)camera_from_intrinsics(500, 500, 640, 240, {320, 240});
      },
      ThrowsMessage<InputError>(HasSubstr("another resolution")));
  EXPECT_THAT(
      [] {
        (void)camera_from_intrinsics(0, 500, 160, 120, {320, 240});
      },
      ThrowsMessage<InputError>(HasSubstr("focal lengths")));
}

// Eq. 14 by hand: asin(0.02/2) = 0.01000017 rad; 45 degrees = 0.78539816 rad; quotient 78.5385, so 79.
TEST(IdealResolution, PaperSensorAtTwoMetres) {
  EXPECT_EQ(ideal_resolution(square_camera(45, 320), 0.02, 2.0), (Resolution{79, 79}));
}

// 92.5 x 72.32 degrees, 2 cm, 1.5 m: asin(0.02/1.5) = 0.01333373; 1.6144296/.. = 121.08, 1.2622221/.. = 94.66.
TEST(IdealResolution, EachAxisIsRoundedUpOnItsOwn) {
  const RangeCamera camera = camera_from_apertures(radians(92.5), radians(72.32), {320, 240});
  EXPECT_EQ(ideal_resolution(camera, 0.02, 1.5), (Resolution{122, 95}));
}

TEST(IdealResolution, AWholeMultipleIsNotRoundedUp) {
  const double distance = 0.02 / std::sin(radians(45) / 50);
  EXPECT_EQ(ideal_resolution(square_camera(45, 320), 0.02, distance), (Resolution{50, 50}));
}

TEST(IdealResolution, NearerThanAVoxelItStaysDefined) {
  EXPECT_EQ(ideal_resolution(square_camera(45, 320), 0.02, 0.001), (Resolution{1, 1}));
  EXPECT_THROW((void)ideal_resolution(square_camera(45, 320), 0, 2), InputError);
  EXPECT_THROW((void)ideal_resolution(square_camera(45, 320), 0.02, std::nan("")), InputError);
}

TEST(Resolution, CountsAllRaysOfTheLargestCamera) { EXPECT_EQ((Resolution{16384, 16384}.rays()), 268'435'456); }

TEST(RangeCamera, RefusesMoreRaysThanIndicesReach) {
  const RangeCamera camera = square_camera(45, 320);
  EXPECT_EQ(camera.rays({16384, 16384}).resolution, (Resolution{16384, 16384}));
  for (const Resolution& beyond : {Resolution{16385, 5}, Resolution{5, 1 << 30}, Resolution{0, 5}, Resolution{5, -1}})
    EXPECT_THAT([&] { (void)camera.rays(beyond); }, ThrowsMessage<InputError>(HasSubstr("rays of a view = ")));
}

// 45 degrees at d voxels: about 0.7854 d rays per axis.
TEST(IdealResolution, BeyondTheLimitIsRefusedWithWhatItWouldBe) {
  const RangeCamera camera = square_camera(45, 320);
  EXPECT_EQ(ideal_resolution(camera, 1, 20'000).columns, 15'708);
  EXPECT_THAT([&] { (void)ideal_resolution(camera, 1, 21'000); },
              ThrowsMessage<InputError>(HasSubstr("would be 16494x16494, more than 16384x16384")));
  EXPECT_THROW((void)ideal_resolution(camera_from_apertures(3.1, 3.1, {10, 10}), 1, 1e6), InputError);
}

}  // namespace
}  // namespace vantage
