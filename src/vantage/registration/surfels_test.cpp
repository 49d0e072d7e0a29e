#include "vantage/registration/surfels.hpp"

#include <gtest/gtest.h>

#include "vantage/core/random.hpp"
#include "vantage/registration/point_index.hpp"

namespace vantage {
namespace {

/// A unit square of random points about z = height, noisy in height and in their normals.
PointCloud noisy_square(double height, double noise, double facing, double normal_noise, Random& random) {
  PointCloud cloud;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 normal = (Vec3(0, 0, facing) + normal_noise * random.normal3()).normalized();
    cloud.add({random.uniform(), random.uniform(), height + noise * random.normal()},
              normal.z() * facing > 0 ? normal : Vec3(-normal));
  }
  return cloud;
}

TEST(Surfels, FindThePlaneUnderNoise) {
  Random random(5);
  const PointCloud cloud = noisy_square(0.025, 0.003, 1, 0.5, random);
  const Surfels surfels = make_surfels(cloud, 0.05);
  // 20 x 20 cells; where the first normal of a cell is very wrong, a second side of a few points splits off.
  EXPECT_GE(surfels.size(), 400U);
  EXPECT_LE(surfels.size(), 420U);
  EXPECT_GT(surfels.flat_share(), 0.95);
  int flat = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (surfels.is_flat[i] == 0) continue;
    ++flat;
    EXPECT_GT(surfels.cloud.normals[i].z(), std::cos(radians(8)));
  }
  EXPECT_GE(flat, 390);
  EXPECT_LT(make_surfels(cloud, 0.003).flat_share(), 0.5);  // cells as small as the noise show no surface
}

TEST(Surfels, KeepTheSidesOfAThinWallApart) {
  Random random(6);
  PointCloud cloud = noisy_square(0.03, 0, 1, 0.1, random);
  const PointCloud below = noisy_square(0.02, 0, -1, 0.1, random);
  for (std::size_t i = 0; i < below.size(); ++i) cloud.add(below.points[i], below.normals[i]);
  const Surfels surfels = make_surfels(cloud, 0.05);
  EXPECT_EQ(surfels.size(), 800U);
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const bool is_top = surfels.cloud.points[i].z() > 0.025;
    EXPECT_NEAR(surfels.cloud.points[i].z(), is_top ? 0.03 : 0.02, 1e-9);
    EXPECT_NEAR(surfels.cloud.normals[i].z(), is_top ? 1 : -1, 1e-9);
  }
}

TEST(PointIndex, FindsWhatALoopOverAllPointsFinds) {
  Random random(7);
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) points.push_back(random.normal3());
  const PointIndex index(points);
  int queries = 0;
  for (; queries < 300; ++queries) {
    const Vec3 query = 1.5 * random.normal3();
    double least = 1e9;
    for (const Vec3& point : points) least = std::min(least, (point - query).squaredNorm());
    const auto nearest = index.nearest(query);
    ASSERT_TRUE(nearest.has_value());
    EXPECT_DOUBLE_EQ(nearest->squared_distance, least);
    EXPECT_EQ(index.nearest(query, 5).front().index, nearest->index);
  }
  EXPECT_EQ(queries, 300);
  EXPECT_FALSE(PointIndex({}).nearest(Vec3::Zero()).has_value());
}

TEST(PointSpacing, IsThePitchOfASquareGrid) {
  std::vector<Vec3> points;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) points.push_back({0.01 * x, 0.01 * y, 0});
  }
  EXPECT_NEAR(point_spacing(PointIndex(points)), 0.01, 1e-9);
}

}  // namespace
}  // namespace vantage
