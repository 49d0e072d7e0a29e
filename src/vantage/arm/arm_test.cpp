#include "vantage/arm/arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "support/sample_arm.hpp"
#include "vantage/arm/arm_collision.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

ArmOptions options() {
  ArmOptions result;
  result.home.resize(6);
  for (Eigen::Index j = 0; j < 6; ++j)
    result.home[j] = radians(std::array{0, -20, 110, -60, -90, 0}[static_cast<std::size_t>(j)]);
  return result;
}

/// Something unknown of 15 cm on a table.
struct ArmAtATable : public ::testing::Test {
  Arm arm{test::sample_arm(), options()};
  Vec3 object{0.62, 0, 0.065};
  VoxelMap map{SceneOptions{object, 0.005, Index3::Constant(101), Index3::Constant(30)}};
  std::vector<Box3> table{Box3(Vec3(-0.4, -0.8, -0.1), Vec3(1.3, 0.8, 0))};
  Candidates candidates = view_sphere(80, 0.32, object);
};

TEST_F(ArmAtATable, EveryViewIsReachedOrHasAReason) {
  const auto mobility = arm.among({map, table});
  int reached = 0, below = 0;
  for (const View& view : candidates.views) {
    const auto reason = mobility->why_unreachable(view);
    if (view.position().z() < 0) {
      ++below;
      EXPECT_TRUE(reason);
    }
    if (reason) {
      EXPECT_FALSE(reason->empty());
      continue;
    }
    ++reached;
    bool some_are_free = false;
    const ArmCollision collision(arm.kinematics(), arm.options().padding, {map, table});
    const auto all = arm.inverse(view);
    for (const Eigen::VectorXd& joints : *all) some_are_free |= !collision.why_touching(joints);
    EXPECT_TRUE(some_are_free);
  }
  EXPECT_GE(reached, 20);
  EXPECT_GT(below, 10);
  EXPECT_EQ(mobility->why_unreachable(view_towards(Vec3(3, 0, 1), object)),
            "no joints within their limits bring the sensor there");
}

TEST_F(ArmAtATable, MovesAreClearAndNoCheaperThanTheLeastCost) {
  const auto mobility = arm.among({map, table});
  const ArmCollision exact(arm.kinematics(), 0, {map, table});
  RobotState at = *arm.home();
  int moves = 0, around = 0;
  std::int64_t places = 0;
  for (const View& view : candidates.views) {
    if (mobility->why_unreachable(view) || moves >= 12) continue;
    const double least = mobility->least_cost(at, view);
    const Move move = mobility->move(at, view);
    ASSERT_TRUE(move.possible()) << move.why_not;
    ++moves;
    around += move.path.size() > 2 ? 1 : 0;
    EXPECT_GE(move.cost, least * (1 - 1e-12));
    EXPECT_EQ(move.path.front().joints, at.joints);
    EXPECT_LT((arm.kinematics().world_from_sensor(move.path.back().joints).translation() - view.position()).norm(),
              1e-6);
    double length = 0;
    for (std::size_t i = 1; i < move.path.size(); ++i) {
      const Eigen::VectorXd way = move.path[i].joints - move.path[i - 1].joints;
      length += way.norm();
      for (int step = 0; step <= 100; ++step, ++places) {
        const Eigen::VectorXd joints = move.path[i - 1].joints + step / 100.0 * way;
        EXPECT_TRUE(arm.kinematics().within_limits(joints));
        const auto reason = exact.why_touching(joints);
        ASSERT_FALSE(reason) << *reason;
      }
    }
    EXPECT_NEAR(length, move.cost, 1e-9);
    at = move.path.back();
  }
  EXPECT_EQ(moves, 12);
  EXPECT_GT(places, 1200);
  RecordProperty("around", around);
}

TEST_F(ArmAtATable, AnswersAreTheSameForAnyNumberOfThreads) {
  std::vector<std::vector<double>> costs;
  for (const std::size_t count : {1U, 2U}) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, count);
    const Arm fresh(test::sample_arm(), options());
    const auto mobility = fresh.among({map, table});
    std::vector<double> cost(20, -1);
    parallel_for(cost.size(), [&](std::size_t i) {
      const View& view = candidates.views[i];
      if (!mobility->why_unreachable(view)) cost[i] = mobility->move(*fresh.home(), view).cost;
    });
    costs.push_back(cost);
  }
  EXPECT_EQ(costs[0], costs[1]);
}

TEST_F(ArmAtATable, RefusesOptionsThatDoNotFit) {
  const auto error_of = [](const ArmOptions& bad) -> std::string {
    try {
      const Arm built(test::sample_arm(), bad);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  ArmOptions bad = options();
  bad.home.conservativeResize(5);
  EXPECT_EQ(error_of(bad), "home has 5 values; the arm has 6 joints");
  bad = options();
  bad.home[2] = 3;
  EXPECT_EQ(error_of(bad), "home: joint elbow at 3 is beyond its limits -2.9 .. 2.9");
  bad = options();
  bad.home[2] = 2.88;
  bad.home[1] = 0;
  EXPECT_THAT(error_of(bad), HasSubstr("home: link"));
  bad = options();
  bad.weights = Eigen::VectorXd::Zero(6);
  EXPECT_EQ(error_of(bad), "joint-weights: must be positive");
  bad = options();
  bad.padding = 0;
  EXPECT_THAT(error_of(bad), HasSubstr("padding"));
}

TEST(Arm, RemembersTheJointsOfViewsWithinALimit) {
  ArmOptions few = options();
  few.most_remembered = 8;
  const Arm arm(test::sample_arm(), few), same(test::sample_arm(), options());
  const Candidates candidates = view_sphere(20, 0.32, Vec3(0.62, 0, 0.065));
  const auto first = arm.inverse(candidates.views[0]);
  EXPECT_EQ(arm.inverse(candidates.views[0]), first) << "the same, not computed again";
  for (const View& view : candidates.views) {
    EXPECT_EQ(*arm.inverse(view), *same.inverse(view));
    EXPECT_EQ(*arm.inverse(candidates.views[0]), *first);
    EXPECT_LE(arm.remembered(), 8U);
  }
  EXPECT_EQ(arm.inverse(candidates.views[0]), first) << "asked for all the time, so it is never forgotten";
  EXPECT_EQ(same.remembered(), 20U);
}

TEST(Arm, LinksThatMayTouchAreNamed) {
  ArmOptions folded = options();
  folded.home = Eigen::VectorXd::Zero(6);
  folded.home[2] = radians(165);  // the forearm lies along the upper arm
  std::string error;
  try {
    (void)Arm(test::sample_arm(), folded);
  } catch (const InputError& refused) {
    error = refused.what();
  }
  ASSERT_THAT(error, HasSubstr("home: link "));
  EXPECT_THAT(error, HasSubstr("may-touch: LINK LINK"));
  for (const char* a : {"base", "shoulder", "upper_arm"}) {
    for (const char* b : {"forearm", "wrist_1_link", "wrist_2_link", "wrist_3_link", "camera"})
      folded.may_touch.emplace_back(b, a);
  }
  EXPECT_NO_THROW((void)Arm(test::sample_arm(), folded));
  folded.may_touch = {{"base", "elbow"}};
  EXPECT_THROW((void)Arm(test::sample_arm(), folded), InputError) << "a joint, no link";
  folded.may_touch = {{"base", "base"}};
  EXPECT_THROW((void)Arm(test::sample_arm(), folded), InputError);
}

}  // namespace
}  // namespace vantage
