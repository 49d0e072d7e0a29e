#include "vantage/core/geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(LookAt, HandComputedAxes) {
  // From +x towards the origin: forward -x, up +z, so right = -x cross z = +y and down = -z.
  const Pose pose = look_at({2, 0, 0}, Vec3::Zero());
  EXPECT_TRUE(pose.linear().col(0).isApprox(Vec3(0, 1, 0), 1e-15));
  EXPECT_TRUE(pose.linear().col(1).isApprox(Vec3(0, 0, -1), 1e-15));
  EXPECT_TRUE(pose.linear().col(2).isApprox(Vec3(-1, 0, 0), 1e-15));
  EXPECT_EQ(pose.translation(), Vec3(2, 0, 0));
}

TEST(LookAt, StraightDownTakesYAsUp) {
  const Pose pose = look_at({0, 0, 2}, Vec3::Zero());
  EXPECT_TRUE(pose.linear().col(2).isApprox(Vec3(0, 0, -1), 1e-15));
  EXPECT_TRUE(pose.linear().col(1).isApprox(Vec3(0, -1, 0), 1e-15));  // down is minus up
  EXPECT_TRUE(pose.linear().col(0).isApprox(Vec3(1, 0, 0), 1e-15));
}

TEST(LookAt, UpChangesAtAxisZ0_999) {
  const auto down_from = [](double z) {
    return look_at(Vec3(std::sqrt(1 - z * z), 0, z), Vec3::Zero()).linear().col(1).eval();
  };
  EXPECT_LT(down_from(0.9989).z(), 0);  // up is +z
  EXPECT_NEAR(down_from(0.9989).y(), 0, 1e-12);
  EXPECT_NEAR(down_from(0.9991).y(), -1, 1e-12);  // up is +y
}

TEST(LookAt, IsAlwaysAProperRotationThatLooksAtTheTarget) {
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 position = 3 * random.normal3();
    const Vec3 target = random.normal3();
    const Pose pose = look_at(position, target);
    const Mat3 rotation = pose.linear();
    ASSERT_LT((rotation.transpose() * rotation - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    ASSERT_GT(rotation.determinant(), 0);
    const Vec3 seen = pose.inverse() * target;
    ASSERT_NEAR(seen.x(), 0, 1e-13);
    ASSERT_NEAR(seen.y(), 0, 1e-13);
    ASSERT_GT(seen.z(), 0);
  }
}

TEST(LookAt, RefusesToLookAtItself) {
  EXPECT_THAT(([] { (void)look_at({1, 2, 3}, {1, 2, 3}); }), ThrowsMessage<InputError>(HasSubstr("same point")));
}

TEST(RotationAngle, IsExactForSmallAndLargeAngles) {
  Random random(12);
  for (const double angle : {0.0, 1e-12, 1e-8, 1e-3, 1.0, 3.0, 3.14159265}) {
    const Mat3 start = Eigen::AngleAxisd(random.uniform(-3, 3), random.unit_vector()).toRotationMatrix();
    const Mat3 turned = start * Eigen::AngleAxisd(angle, random.unit_vector()).toRotationMatrix();
    EXPECT_NEAR(rotation_angle(start, turned), angle, 1e-14 + 1e-7 * (angle > 3.1 ? 1 : 0)) << angle;
    EXPECT_NEAR(rotation_angle(turned, start), angle, 1e-14 + 1e-7 * (angle > 3.1 ? 1 : 0)) << angle;
  }
}

TEST(RigidPose, KeepsAnExactRotationBitForBit) {
  const Pose pose = look_at({0, 0, 2}, Vec3::Zero());
  EXPECT_EQ(rigid_pose(pose.matrix(), "pose").matrix(), pose.matrix());
}

TEST(RigidPose, OrthonormalisesRoundedEntries) {
  const Pose pose = look_at({1, 2, 3}, Vec3::Zero());
  const Eigen::Matrix4d rounded = (pose.matrix() * 1e4).array().round() / 1e4;
  const Mat3 rotation = rigid_pose(rounded, "pose").linear();
  EXPECT_LT((rotation.transpose() * rotation - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-15 * 4);
  EXPECT_LT(rotation_angle(rotation, pose.linear()), 1e-4);
}

TEST(RigidPose, NamesWhatIsWrong) {
  const Eigen::Matrix4d good = look_at({1, 2, 3}, Vec3::Zero()).matrix();
  const auto error_of = [&](int row, int column, double value) {
    Eigen::Matrix4d bad = good;
    bad(row, column) = value;
    return [bad] { (void)rigid_pose(bad, "frame 7"); };
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of(1, 3, nan),
              ThrowsMessage<InputError>(HasSubstr("frame 7: the pose has an entry that is not a finite")));
  EXPECT_THAT(error_of(3, 0, 0.5), ThrowsMessage<InputError>(HasSubstr("must be 0 0 0 1")));
  const auto scaled = [&](const Vec3& scale) {
    Eigen::Matrix4d bad = good;
    bad.topLeftCorner<3, 3>() = good.topLeftCorner<3, 3>() * scale.asDiagonal();
    return [bad] { (void)rigid_pose(bad, "frame 7"); };
  };
  EXPECT_THAT(scaled({1, 1, -1}), ThrowsMessage<InputError>(HasSubstr("mirrored")));
  EXPECT_THAT(scaled({1, 1, 1.01}), ThrowsMessage<InputError>(HasSubstr("not orthonormal")));
}

TEST(IndexBox, SizeAndContains) {
  const IndexBox box{Index3(1, 2, 3), Index3(1, 4, 5)};
  EXPECT_EQ(box.size(), Index3(1, 3, 3));
  EXPECT_TRUE(box.contains({1, 4, 3}));
  EXPECT_FALSE(box.contains({0, 4, 3}));
  EXPECT_FALSE(box.contains({1, 5, 3}));
  EXPECT_EQ(IndexBox{}.size(), Index3::Zero());
}

}  // namespace
}  // namespace vantage
