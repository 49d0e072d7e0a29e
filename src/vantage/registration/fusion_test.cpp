#include "vantage/registration/fusion.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

/// A sensor at `position` that looks along -z at points near the plane z = 0.
Pose above(const Vec3& position) {
  Pose pose = Pose::Identity();
  pose.linear().col(1) = -Vec3::UnitY();
  pose.linear().col(2) = -Vec3::UnitZ();
  pose.translation() = position;
  return pose;
}

PointCloud in_sensor(const Pose& world_from_sensor, const std::vector<Vec3>& points, const Vec3& normal) {
  PointCloud cloud;
  for (const Vec3& point : points) {
    cloud.add(world_from_sensor.inverse() * point, world_from_sensor.linear().transpose() * normal);
  }
  return cloud;
}

TEST(FusedCloud, KeepsThePointSeenMostPerpendicularlyInEachCell) {
  FusedCloud fused(0.1);
  const Vec3 up = Vec3::UnitZ();
  const Pose oblique = above({1, 0, 1}), upright = above({0, 0, 1});
  fused.merge(in_sensor(oblique, {Vec3(0.01, 0.01, 0), Vec3(0.11, 0.01, 0)}, up), oblique);
  ASSERT_EQ(fused.cloud().size(), 2U);
  EXPECT_NEAR(fused.quality()[0], 1 / Vec3(0.99, -0.01, 1).norm(), 1e-12);
  fused.merge(in_sensor(upright, {Vec3(0.02, 0.02, 0)}, up), upright);
  ASSERT_EQ(fused.cloud().size(), 2U);
  EXPECT_NEAR((fused.cloud().points[0] - Vec3(0.02, 0.02, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((fused.cloud().points[1] - Vec3(0.11, 0.01, 0)).norm(), 0, 1e-12);
  fused.merge(in_sensor(oblique, {Vec3(0.03, 0.03, 0)}, up), oblique);  // worse: changes nothing
  EXPECT_NEAR((fused.cloud().points[0] - Vec3(0.02, 0.02, 0)).norm(), 0, 1e-12);
  EXPECT_GT(fused.quality()[0], 0.999);
}

TEST(FusedCloud, KeepsBothSidesOfAThinWall) {
  FusedCloud fused(0.1);
  const Pose sensor = above({0, 0, 1});
  fused.merge(in_sensor(sensor, {Vec3(0.01, 0.01, 0.06)}, Vec3::UnitZ()), sensor);
  fused.merge(in_sensor(sensor, {Vec3(0.01, 0.01, 0.05)}, -Vec3::UnitZ()), sensor);
  EXPECT_EQ(fused.cloud().size(), 2U);
}

TEST(FusedCloud, MergingTheSameScanAgainAddsNothing) {
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 5000; ++i) points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), 0});
  const Pose sensor = above({0, 0, 2});
  FusedCloud fused(0.05);
  fused.merge(in_sensor(sensor, points, Vec3::UnitZ()), sensor);
  const PointCloud once = fused.cloud();
  EXPECT_GT(once.size(), 1000U);
  EXPECT_LE(once.size(), 2 * 1600U);  // 40 x 40 cells; rounding may put points of the plane on either side of z = 0
  fused.merge(in_sensor(sensor, points, Vec3::UnitZ()), sensor);
  EXPECT_EQ(fused.cloud().points, once.points);
  EXPECT_EQ(fused.cloud().normals, once.normals);
}

TEST(FusedCloud, APointWithANormalReplacesOneWithout) {
  FusedCloud fused(0.1);
  const Pose sensor = above({0, 0, 1});
  fused.merge(in_sensor(sensor, {Vec3(0.01, 0.01, 0)}, Vec3::Zero()), sensor);
  EXPECT_EQ(fused.quality()[0], 0);
  fused.merge(in_sensor(sensor, {Vec3(0.02, 0.02, 0)}, Vec3::UnitZ()), sensor);
  ASSERT_EQ(fused.cloud().size(), 1U);
  EXPECT_NEAR(fused.cloud().normals[0].z(), 1, 1e-12);
}

TEST(FusedCloud, RejectsASpacingThatIsNotPositive) {
  try {
    const FusedCloud fused(-0.5);
    FAIL() << "accepted a negative spacing";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "fused cloud: spacing = -0.5 m: must be positive");
  }
}

}  // namespace
}  // namespace vantage
