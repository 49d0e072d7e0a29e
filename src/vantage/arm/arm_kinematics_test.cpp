#include "vantage/arm/arm_kinematics.hpp"

#include <gtest/gtest.h>

#include "support/sample_arm.hpp"

namespace vantage {
namespace {

TEST(ArmKinematics, TheSensorIsWhereADrawingHasIt) {
  const ArmKinematics arm(test::sample_arm(), Pose::Identity());
  // Straight up: heights 0.18 + 0.58 + 0.54 + 0.12, sideways 0.14 - 0.12 + 0.13 + 0.08 + 0.03; the lens looks sideways.
  const Pose up = arm.world_from_sensor(Eigen::VectorXd::Zero(6));
  EXPECT_TRUE(up.translation().isApprox(Vec3(0, 0.26, 1.42), 1e-12));
  EXPECT_TRUE(up.linear().col(2).isApprox(Vec3::UnitY(), 1e-12));
  // Lifted forwards by a right angle: what was up points along x.
  Eigen::VectorXd joints = Eigen::VectorXd::Zero(6);
  joints[1] = radians(90);
  EXPECT_TRUE(arm.world_from_sensor(joints).translation().isApprox(Vec3(1.24, 0.26, 0.18), 1e-12));
  // And turned to the left.
  joints[0] = radians(90);
  EXPECT_TRUE(arm.world_from_sensor(joints).translation().isApprox(Vec3(-0.26, 1.24, 0.18), 1e-12));
}

TEST(ArmKinematics, TheJointsBehindAPoseAreFoundAgain) {
  Pose base = Pose::Identity();
  base.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  base.translation() = Vec3(0.3, -0.2, 0.1);
  const ArmKinematics arm(test::sample_arm(), base);
  Random random(7);
  constexpr int poses = 200;
  int found_again = 0;
  std::size_t solutions = 0;
  for (int i = 0; i < poses; ++i) {
    const Eigen::VectorXd joints = test::random_joints(arm.arm(), random);
    const Pose pose = arm.world_from_sensor(joints);
    const std::vector<Eigen::VectorXd> all = arm.inverse(pose);
    solutions += all.size();
    bool is_among_them = false;
    for (const Eigen::VectorXd& each : all) {
      EXPECT_TRUE(arm.within_limits(each));
      const Pose reached = arm.world_from_sensor(each);
      EXPECT_LT((reached.translation() - pose.translation()).norm(), 1e-6);
      EXPECT_LT(rotation_angle(reached.linear(), pose.linear()), 1e-6);
      is_among_them |= (arm.nearest_turns(each, joints) - joints).cwiseAbs().maxCoeff() < 1e-3;
    }
    found_again += is_among_them ? 1 : 0;
  }
  RecordProperty("solutions", static_cast<int>(solutions));
  EXPECT_GE(found_again, 195) << "the search is numeric: a few of many solutions may be missed";
  EXPECT_GT(solutions, 3U * poses) << "an arm like this has up to eight";
}

TEST(ArmKinematics, PosesOutOfReachHaveNoJoints) {
  const ArmKinematics arm(test::sample_arm(), Pose::Identity());
  EXPECT_TRUE(arm.inverse(look_at(Vec3(2, 0, 0.5), Vec3::Zero())).empty());
  EXPECT_TRUE(arm.inverse(look_at(Vec3(0, 0, 2.5), Vec3::Zero())).empty());
}

TEST(ArmKinematics, NoPointMovesFartherThanItsReachTells) {
  const ArmKinematics arm(test::sample_arm(), Pose::Identity());
  Random random(8);
  int moves = 0;
  for (; moves < 400; ++moves) {
    const Eigen::VectorXd from = test::random_joints(arm.arm(), random);
    const Eigen::VectorXd way = 0.1 * (test::random_joints(arm.arm(), random) - from);
    const auto before = arm.world_from_joints(from);
    const auto after = arm.world_from_joints(from + way);
    for (const ArmBody& body : arm.arm().bodies) {
      if (body.joint < 0) continue;
      for (const LinkShape& shape : body.shapes) {
        const Vec3 on_the_rim = shape.joint_from_shape * Vec3(shape.size.x() / 2, 0, shape.size.y() / 2);
        const auto frame = static_cast<std::size_t>(body.joint);
        EXPECT_LE((after[frame] * on_the_rim - before[frame] * on_the_rim).norm(),
                  way.cwiseAbs().dot(arm.reach_of_joints()));
      }
    }
  }
  EXPECT_EQ(moves, 400);
}

TEST(ArmKinematics, TurnsEndAtTheLimits) {
  const ArmKinematics arm(test::sample_arm(), Pose::Identity());
  Eigen::VectorXd joints = Eigen::VectorXd::Zero(6);
  Eigen::VectorXd reference = Eigen::VectorXd::Constant(6, 6.0);
  joints[0] = 0.5;  // 0.5 + 2 pi is nearer to 6 but beyond 2 pi
  joints[1] = -0.5;
  const Eigen::VectorXd nearest = arm.nearest_turns(joints, reference);
  EXPECT_DOUBLE_EQ(nearest[0], 0.5);
  EXPECT_DOUBLE_EQ(nearest[1], 2 * std::numbers::pi - 0.5);
  EXPECT_TRUE(arm.within_limits(nearest));
}

}  // namespace
}  // namespace vantage
