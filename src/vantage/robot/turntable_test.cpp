#include "vantage/robot/turntable.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/candidates/candidates.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(Turntable, ReachesTheViewsBetweenItsElevations) {
  const VoxelMap map{SceneOptions{}};
  const Turntable table(TurntableOptions{.radius = 2, .arc = {10, 80}});
  const auto mobility = table.among({map});
  int reached = 0;
  for (const View& view : view_sphere(320, 2, Vec3::Zero()).views) {
    const double elevation = degrees(std::asin(view.position().z() / 2));
    const auto reason = mobility->why_unreachable(view);
    EXPECT_EQ(!reason, elevation >= 10 && elevation <= 80) << elevation << reason.value_or("");
    reached += reason ? 0 : 1;
  }
  EXPECT_GT(reached, 80);
  EXPECT_THAT(mobility->why_unreachable(view_towards(Vec3(1, 0, 1), Vec3::Zero())).value_or(""),
              HasSubstr("not on the arc: 1.41"));
  EXPECT_THAT(mobility->why_unreachable(view_towards(2 * Vec3(1, 0, 1).normalized(), Vec3(0, 1, 0))).value_or(""),
              HasSubstr("cannot turn"));
}

TEST(Turntable, TurnsTheShorterWayRoundUnlessItHasLimits) {
  const VoxelMap map{SceneOptions{}};
  TurntableOptions options{.radius = 1, .arc = {-90, 90}, .weights = {2, 3}};
  const Turntable endless(options);
  options.turn = {-179, 179};
  const Turntable limited(options);
  const View from = endless.view_of({radians(170), 0});
  const View to = endless.view_of({radians(-170), radians(10)});
  const Move shorter = endless.among({map})->move(*endless.state_at(from), to);
  ASSERT_TRUE(shorter.possible());
  EXPECT_NEAR(shorter.cost, 2 * radians(20) + 3 * radians(10), 1e-9);
  const Move longer = limited.among({map})->move(*limited.state_at(from), to);
  ASSERT_TRUE(longer.possible());
  EXPECT_NEAR(longer.cost, 2 * radians(340) + 3 * radians(10), 1e-9);
}

TEST(Turntable, TakesViewsThatItCannotHoldForTheNearestOfItsOwn) {
  const Turntable table(TurntableOptions{.radius = 2, .arc = {10, 80}});
  const View view = view_towards(Vec3(3, 0, 0), Vec3(0, 1, 0));  // off the arc, too low, looking aside
  ASSERT_FALSE(table.state_at(view));
  const RobotState state = table.state_near(view);
  EXPECT_TRUE(state.joints.isApprox(Eigen::Vector2d(0, radians(10))));
  EXPECT_TRUE(table.state_at(state.view)) << "what it is taken for is within the limits";
}

TEST(Turntable, RidesOneAxisAfterTheOtherWhereBothAtOnceTouch) {
  const VoxelMap map{SceneOptions{}};
  const Turntable table(TurntableOptions{.radius = 1.5, .arc = {-90, 90}, .head_radius = 0.05});
  const View from = table.view_of({0, 0});
  const View to = table.view_of({radians(90), radians(60)});
  const Vec3 halfway = table.view_of({radians(45), radians(30)}).position();
  std::vector<Box3> post{Box3(halfway - Vec3::Constant(0.1), halfway + Vec3::Constant(0.1))};
  const Move move = table.among({map, post})->move(*table.state_at(from), to);
  ASSERT_TRUE(move.possible());
  EXPECT_EQ(move.path.size(), 3U);
  // A wall that no arc at this distance gets past.
  const std::vector<Box3> wall{Box3(Vec3(-2, 0.3, -2), Vec3(2, 0.4, 2))};
  const Move blocked = table.among({map, wall})->move(*table.state_at(from), to);
  EXPECT_FALSE(blocked.possible());
  EXPECT_THAT(blocked.why_not, HasSubstr("known free space"));
}

TEST(Turntable, RefusesABadArc) {
  EXPECT_THROW(Turntable(TurntableOptions{.arc = {50, 20}}), InputError);
  EXPECT_THROW(Turntable(TurntableOptions{.radius = 0}), InputError);
}

}  // namespace
}  // namespace vantage
