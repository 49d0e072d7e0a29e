#include "vantage/robot/gantry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(Gantry, JointsGiveTheViewBack) {
  Random random(1);
  int views = 0;
  for (; views < 500; ++views) {
    const View view = view_towards(random.normal3(), random.normal3());
    if (std::abs(view.axis().z()) > 0.99) continue;
    EXPECT_TRUE(gantry_view(gantry_joints(view)).world_from_sensor.isApprox(view.world_from_sensor, 1e-9));
  }
  Eigen::VectorXd joints(5);
  joints << 1, 2, 3, radians(90), radians(-90);  // straight down, the image's right to +x
  EXPECT_TRUE(gantry_view(joints).axis().isApprox(-Vec3::UnitZ()));
  EXPECT_TRUE(gantry_view(joints).world_from_sensor.linear().col(0).isApprox(Vec3::UnitX()));
  EXPECT_TRUE(gantry_joints(gantry_view(joints)).isApprox(joints));
}

TEST(Gantry, SaysWhichLimitAViewIsBeyond) {
  const VoxelMap map{SceneOptions{}};
  GantryOptions options;
  options.axes = Box3(Vec3(-2, -2, 0), Vec3(2, 2, 2));
  options.tilt = {-80, 10};
  options.pan = {-170, 170};
  const Gantry gantry(options);
  const auto mobility = gantry.among({map});
  const auto why = [&](const View& view) { return mobility->why_unreachable(view).value_or(""); };
  EXPECT_EQ(why(view_towards(Vec3(-1, 0, 1), Vec3::Zero())), "");
  EXPECT_EQ(why(view_towards(Vec3(-1, 0, 2.5), Vec3::Zero())), "axis z at 2.5 m is beyond its limits 0 .. 2");
  EXPECT_EQ(why(view_towards(Vec3(1, 0, 1), Vec3::Zero())), "pan 180 degrees is beyond its limits -170 .. 170");
  EXPECT_THAT(why(view_towards(Vec3(0, 1, 1), Vec3(0, 2, 3))), HasSubstr("tilt"));
  EXPECT_THAT(why(view_towards(Vec3(-0.4, 0, 0.4), Vec3::Zero())), HasSubstr("unmarked voxel"));
  View rolled = view_towards(Vec3(-1, 0, 1), Vec3::Zero());
  rolled.world_from_sensor.rotate(Eigen::AngleAxisd(0.1, Vec3::UnitZ()));
  EXPECT_THAT(why(rolled), HasSubstr("cannot roll"));
}

TEST(Gantry, TakesViewsThatItCannotHoldForTheNearestOfItsOwn) {
  GantryOptions options;
  options.axes = Box3(Vec3(-2, -2, 0), Vec3(2, 2, 2));
  options.tilt = {-80, 10};
  const Gantry gantry(options);
  View view = view_towards(Vec3(-1, 0, 3), Vec3(0, 0, 4));  // above the axes, looking up by 45 degrees
  view.world_from_sensor.rotate(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
  ASSERT_FALSE(gantry.state_at(view));
  const RobotState state = gantry.state_near(view);
  ASSERT_EQ(state.joints.size(), 5);
  EXPECT_TRUE(state.view.position().isApprox(Vec3(-1, 0, 2)));
  EXPECT_LE(std::asin(state.view.axis().z()), radians(10) + 1e-9);
  EXPECT_TRUE(gantry.state_at(state.view)) << "what it is taken for is within the limits";
}

TEST(Gantry, AMoveCostsItsWayAndTheLargerTurn) {
  const VoxelMap map{SceneOptions{}};
  const Gantry gantry(GantryOptions{.axes = Box3(Vec3(-3, -3, -3), Vec3(3, 3, 3)), .turn_cost = 0.5});
  const auto mobility = gantry.among({map});
  const View from = gantry_view((Eigen::VectorXd(5) << -1, 0, 1, 0, radians(-45)).finished());
  const View to = gantry_view((Eigen::VectorXd(5) << -1, 2, 1, radians(-60), radians(-30)).finished());
  const Move move = mobility->move(*gantry.state_at(from), to);
  ASSERT_TRUE(move.possible());
  EXPECT_NEAR(move.cost, 2 + 0.5 * radians(60), 1e-9);
  EXPECT_NEAR(mobility->least_cost(*gantry.state_at(from), to), move.cost, 1e-9);
  const View behind = view_towards(Vec3(1, 0, 0.3), Vec3::Zero());
  const Move around = mobility->move(*gantry.state_at(view_towards(Vec3(-1, 0, 0.3), Vec3::Zero())), behind);
  ASSERT_TRUE(around.possible());
  EXPECT_GT(around.path.size(), 2U) << "the unmarked enclosure is in the way";
  EXPECT_TRUE(around.path.back().view.world_from_sensor.isApprox(behind.world_from_sensor));
}

TEST(Gantry, RefusesLimitsInTheWrongOrder) {
  EXPECT_THROW(Gantry(GantryOptions{.pan = {90, -90}}), InputError);
  EXPECT_THROW(Gantry(GantryOptions{.turn_cost = -1}), InputError);
}

}  // namespace
}  // namespace vantage
