#include "vantage/arm/joint_path.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// Two joints in [-1, 1] and a wall at 0 that the second joint passes above `gap` only.
JointSpace room_with_a_wall(double gap) {
  JointSpace space;
  space.lower = Eigen::Vector2d(-1, -1);
  space.upper = Eigen::Vector2d(1, 1);
  space.weights = Eigen::Vector2d(1, 1);
  space.step = 0.2;
  space.is_clear = [gap](const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
    for (int step = 0; step <= 200; ++step) {
      const Eigen::VectorXd at = from + step / 200.0 * (to - from);
      if (std::abs(at[0]) < 0.05 && at[1] < gap) return false;
    }
    return true;
  };
  return space;
}

TEST(JointPath, GoesThroughTheGapAndIsNotMuchLongerThanAString) {
  const JointSpace space = room_with_a_wall(0.7);
  const Eigen::VectorXd start = Eigen::Vector2d(-0.8, 0);
  const Eigen::VectorXd goal = Eigen::Vector2d(0.8, 0);
  const double shortest = 2 * Eigen::Vector2d(0.75, 0.7).norm() + 0.1;
  int found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const auto path = connect(space, start, {goal}, random);
    ASSERT_TRUE(path);
    ++found;
    EXPECT_EQ(path->front(), start);
    EXPECT_EQ(path->back(), goal);
    for (std::size_t i = 1; i < path->size(); ++i) EXPECT_TRUE(space.is_clear((*path)[i - 1], (*path)[i]));
    EXPECT_GE(space.length(*path), shortest - 1e-9);
    EXPECT_LT(space.length(*path), 1.2 * shortest);
  }
  EXPECT_EQ(found, 20);
}

TEST(JointPath, TheSameSeedGivesTheSamePath) {
  const JointSpace space = room_with_a_wall(0.5);
  Random a(3), b(3);
  const auto first = connect(space, Eigen::Vector2d(-0.8, -0.5), {Eigen::Vector2d(0.8, 0)}, a);
  const auto second = connect(space, Eigen::Vector2d(-0.8, -0.5), {Eigen::Vector2d(0.8, 0)}, b);
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  EXPECT_EQ(*first, *second);
}

TEST(JointPath, EndsAtOneOfTheGoalsOrGivesUp) {
  JointSpace space = room_with_a_wall(2);
  space.most_nodes = 300;
  Random random(1);
  const Eigen::VectorXd start = Eigen::Vector2d(-0.8, 0);
  EXPECT_FALSE(connect(space, start, {Eigen::Vector2d(0.8, 0)}, random)) << "the wall has no gap";
  EXPECT_FALSE(connect(space, start, {}, random));
  const Eigen::VectorXd near_side = Eigen::Vector2d(-0.2, 0.9);
  const auto path = connect(space, start, {Eigen::Vector2d(0.8, 0), near_side}, random);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->back(), near_side);
}

}  // namespace
}  // namespace vantage
