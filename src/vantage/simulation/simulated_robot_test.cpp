#include "vantage/simulation/simulated_robot.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/simulation/objects.hpp"

namespace vantage {
namespace {

const View commanded = view_towards(Vec3(2, 0, 0), Vec3::Zero());

TEST(SimulatedRobot, EndsUpAsFarOffAsItsErrorSays) {
  const RangeScanner scanner(make_object("sphere"));
  SimulatedRobotOptions options;
  Mat3 root;
  root << 0.1, 0, 0, 0.05, 0.08, 0, 0, 0.02, 0.03;
  options.error = {Vec3(0.02, 0, -0.01), root * root.transpose()};
  SimulatedRobot robot(scanner, {}, options, 1);
  constexpr int moves = 20000;
  Vec3 sum = Vec3::Zero();
  Mat3 squares = Mat3::Zero();
  for (int i = 0; i < moves; ++i) {
    ASSERT_TRUE(robot.move_to(commanded));
    EXPECT_TRUE(robot.view().position() == commanded.position());
    EXPECT_TRUE(robot.true_view().world_from_sensor.linear() == commanded.world_from_sensor.linear());
    const Vec3 error = robot.true_view().position() - commanded.position();
    sum += error;
    squares += error * error.transpose();
  }
  const Vec3 mean = sum / moves;
  const Mat3 covariance = squares / moves - mean * mean.transpose();
  // Four standard errors of the estimates.
  EXPECT_LT((mean - options.error.mean).cwiseAbs().maxCoeff(), 4 * 0.1 / std::sqrt(moves));
  EXPECT_LT((covariance - options.error.covariance).cwiseAbs().maxCoeff(), 4 * 0.01 * std::sqrt(2.0 / moves));
}

TEST(SimulatedRobot, IsExactOnItsFirstMoveWhereAsked) {
  const RangeScanner scanner(make_object("sphere"));
  SimulatedRobotOptions options;
  options.error = PositioningError::from_deviations(Vec3::Constant(0.1));
  options.first_pose_exact = true;
  SimulatedRobot robot(scanner, {}, options, 1);
  ASSERT_TRUE(robot.move_to(commanded));
  EXPECT_TRUE(robot.true_view().position() == commanded.position());
  ASSERT_TRUE(robot.move_to(commanded));
  EXPECT_FALSE(robot.true_view().position() == commanded.position());
}

TEST(SimulatedRobot, RedrawsErrorsThatLeadWhereItCannotBe) {
  const RangeScanner scanner(make_object("sphere"));
  SimulatedRobotOptions options;
  options.error = PositioningError::from_deviations(Vec3::Constant(0.1));
  const auto in_front = [](const View& view) { return view.position().x() > 2; };
  SimulatedRobot robot(scanner, {}, options, 1, in_front);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(robot.move_to(commanded));
    EXPECT_GT(robot.true_view().position().x(), 2);
  }
  SimulatedRobot nowhere(scanner, {}, options, 1, [](const View&) { return false; });
  EXPECT_FALSE(nowhere.move_to(commanded));
}

TEST(SimulatedRobot, RefusesACovarianceThatIsNone) {
  const RangeScanner scanner(make_object("sphere"));
  SimulatedRobotOptions options;
  options.error.covariance = Vec3(0.1, -0.1, 0.1).asDiagonal();
  EXPECT_THROW(SimulatedRobot(scanner, {}, options, 1), InputError);
}

}  // namespace
}  // namespace vantage
