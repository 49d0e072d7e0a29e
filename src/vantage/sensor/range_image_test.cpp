#include "vantage/sensor/range_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// The image of whatever `depth(x, y)` says for the ray (x, y, 1).
template <class Depth>
RangeImage image_of(const RangeCamera& camera, const Depth& depth) {
  RangeImage image;
  image.camera = camera;
  const RayGrid rays = camera.rays();
  for (int row = 0; row < camera.resolution.rows; ++row) {
    for (int column = 0; column < camera.resolution.columns; ++column) {
      image.depth.push_back(static_cast<float>(depth(rays.x(column), rays.y(row))));
    }
  }
  return image;
}

std::size_t pixel(const RangeImage& image, int column, int row) {
  return static_cast<std::size_t>(row * image.camera.resolution.columns + column);
}

/// Depth at which the ray meets the plane normal.p = distance.
auto plane(const Vec3& normal, double distance) {
  return [=](double x, double y) { return distance / normal.dot(Vec3(x, y, 1)); };
}

auto sphere(const Vec3& center, double radius) {
  return [=](double x, double y) {
    const Vec3 ray(x, y, 1);
    const double b = ray.dot(center);
    const double inside = b * b - ray.squaredNorm() * (center.squaredNorm() - radius * radius);
    return inside < 0 ? std::numeric_limits<double>::infinity() : (b - std::sqrt(inside)) / ray.squaredNorm();
  };
}

double angle_between(const Vec3f& a, const Vec3& b) {
  return std::acos(std::clamp(a.cast<double>().dot(b), -1.0, 1.0));
}

TEST(RangeImageNormals, APlaneHasItsNormalInEveryPixelUpToTheBorder) {
  Random random(21);
  int planes = 0;
  for (int i = 0; i < 50; ++i) {
    Vec3 normal = random.unit_vector();
    if (normal.z() > 0) normal = -normal;
    if (-normal.z() < 0.5) continue;  // up to 60 degrees from the axis
    ++planes;
    const RangeImage image =
        image_of(camera_from_apertures(radians(45), radians(35), {64, 40}), plane(normal, 1.5 * normal.z()));
    for (const Vec3f& found : range_image_normals(image)) ASSERT_LT(angle_between(found, normal), 2e-3);
  }
  EXPECT_GE(planes, 20);
}

TEST(RangeImageNormals, ASphereHasRadialNormalsAwayFromItsRim) {
  const Vec3 center(0.1, -0.05, 2);
  const RangeImage image = image_of(camera_from_apertures(radians(45), radians(45), {160, 160}), sphere(center, 0.4));
  const RayGrid rays = image.camera.rays();
  const std::vector<Vec3f> normals = range_image_normals(image);
  int compared = 0;
  for (int row = 0; row < 160; ++row) {
    for (int column = 0; column < 160; ++column) {
      const float depth = image.at(column, row);
      if (!RangeImage::is_hit(depth)) continue;
      const Vec3 point = point_in_sensor(rays, column, row, static_cast<double>(depth));
      const Vec3 radial = (point - center).normalized();
      if (-radial.dot(point.normalized()) < 0.5) continue;
      ASSERT_LT(degrees(angle_between(normals[pixel(image, column, row)], radial)), 2.0);
      ++compared;
    }
  }
  EXPECT_GT(compared, 2500);
}

TEST(RangeImageNormals, AStepInDepthDoesNotBendNormals) {
  // Two walls facing the sensor, at 1 m and 2 m, that meet in the middle column.
  const RangeImage image = image_of(camera_from_apertures(radians(45), radians(45), {32, 32}),
                                    [](double x, double) { return x < 0 ? 1.0 : 2.0; });
  for (const Vec3f& normal : range_image_normals(image)) ASSERT_LT((normal - Vec3f(0, 0, -1)).norm(), 1e-5F);
}

TEST(RangeImageNormals, ALoneNeighbourOnOneSideIsEnough) {
  RangeImage image =
      image_of(camera_from_apertures(radians(45), radians(45), {8, 8}), [](double, double) { return 1.0; });
  image.depth[pixel(image, 3, 4)] = RangeImage::unknown;
  image.depth[pixel(image, 4, 3)] = RangeImage::no_return;
  const std::vector<Vec3f> normals = range_image_normals(image);
  EXPECT_LT((normals[pixel(image, 4, 4)] - Vec3f(0, 0, -1)).norm(), 1e-6F);
  EXPECT_EQ(normals[pixel(image, 3, 4)], Vec3f::Zero());
  EXPECT_EQ(normals[pixel(image, 4, 3)], Vec3f::Zero());
}

TEST(RangeImageNormals, WithoutANeighbourAlongAnAxisThereIsNoNormal) {
  RangeImage image =
      image_of(camera_from_apertures(radians(45), radians(45), {8, 8}), [](double, double) { return 1.0; });
  image.depth[pixel(image, 3, 4)] = RangeImage::unknown;
  image.depth[pixel(image, 5, 4)] = 3;  // another surface
  const std::vector<Vec3f> normals = range_image_normals(image);
  EXPECT_EQ(normals[pixel(image, 4, 4)], Vec3f::Zero());
  RangeImage line =
      image_of(camera_from_apertures(radians(45), radians(45), {8, 1}), [](double, double) { return 1.0; });
  for (const Vec3f& normal : range_image_normals(line)) EXPECT_EQ(normal, Vec3f::Zero());
}

TEST(RangeImageNormals, TheStepLimitCountsInFootprints) {
  // One pixel of 45 degrees in 8 columns is 0.10355 wide in tangents: at 1 m twelve footprints are 1.2426 m.
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {8, 8});
  const auto wall_with_step = [&](double step) {
    return image_of(camera, [=](double x, double) { return x < 0 ? 1.0 : 1.0 + step; });
  };
  const auto bends = [&](double step, double limit) {
    const RangeImage image = wall_with_step(step);
    const Vec3f normal = range_image_normals(image, {.max_step_in_footprints = limit})[pixel(image, 3, 4)];
    return (normal - Vec3f(0, 0, -1)).norm() > 1e-4F;
  };
  EXPECT_TRUE(bends(1.24, 12));
  EXPECT_FALSE(bends(1.25, 12));
  EXPECT_TRUE(bends(0.10, 1));
  EXPECT_FALSE(bends(0.11, 1));
}

TEST(RangeImageNormals, AllFaceTheSensorAndHaveLengthOne) {
  Random random(22);
  RangeImage image = image_of(camera_from_apertures(radians(70), radians(50), {60, 50}), [&](double, double) {
    const double kind = random.uniform();
    return kind < 0.1 ? 0.0 : kind < 0.2 ? std::numeric_limits<double>::infinity() : random.uniform(0.9, 1.3);
  });
  const RayGrid rays = image.camera.rays();
  const std::vector<Vec3f> normals = range_image_normals(image);
  int found = 0;
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 60; ++column) {
      const Vec3f& normal = normals[pixel(image, column, row)];
      if (normal.isZero(0)) continue;
      ++found;
      ASSERT_NEAR(normal.norm(), 1, 1e-6);
      ASSERT_LT(normal.cast<double>().dot(Vec3(rays.x(column), rays.y(row), 1)), 1e-6);
    }
  }
  EXPECT_GT(found, 1500);
}

TEST(RangeImage, ErrorsNameThePixelOrTheSizes) {
  RangeImage image;
  image.camera.resolution = {4, 3};
  image.depth.assign(11, 1);
  EXPECT_THAT([&] { image.validate(); }, ThrowsMessage<InputError>(HasSubstr("11 depths for 4x3")));
  image.depth.assign(12, 1);
  EXPECT_NO_THROW(image.validate());
  image.depth[6] = -2;
  EXPECT_THAT([&] { image.validate(); }, ThrowsMessage<InputError>(HasSubstr("depth -2 at pixel (2, 1)")));
  image.depth[6] = std::nanf("");
  EXPECT_THAT([&] { image.validate(); }, ThrowsMessage<InputError>(HasSubstr("at pixel (2, 1)")));
  EXPECT_THROW((void)range_image_normals(RangeImage{image}, {.max_step_in_footprints = 0}), InputError);
}

}  // namespace
}  // namespace vantage
