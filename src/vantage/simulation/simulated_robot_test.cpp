#include "vantage/simulation/simulated_robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/simulation/objects.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

const RangeCamera& small_camera() {
  static const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {16, 16});
  return camera;
}

TEST(Perturbed, DrawsTheGivenMeanAndCovariance) {
  PositioningError error;
  error.mean = {0.02, -0.01, 0};
  // Two axes that err together, a singular covariance: the third follows from the first.
  error.covariance << 0.04, 0.01, 0.02, 0.01, 0.09, 0.005, 0.02, 0.005, 0.01;
  ASSERT_NEAR(error.covariance.determinant(), 0, 1e-18);
  const View commanded = view_towards({1, 2, 3}, {0, 0, 0});
  Random random(8);
  constexpr int count = 40'000;
  Vec3 sum = Vec3::Zero();
  Mat3 products = Mat3::Zero();
  for (int i = 0; i < count; ++i) {
    const View reached = perturbed(commanded, error, random);
    ASSERT_EQ(reached.world_from_sensor.linear(), commanded.world_from_sensor.linear());
    const Vec3 offset = reached.position() - commanded.position();
    ASSERT_NEAR((offset - error.mean).z(), 0.5 * (offset - error.mean).x(), 1e-7);
    sum += offset;
    products += (offset - error.mean) * (offset - error.mean).transpose();
  }
  // The means scatter by at most 0.3/200, the covariances by at most 0.09*sqrt(2)/200; limits at four times that.
  EXPECT_LT((sum / count - error.mean).cwiseAbs().maxCoeff(), 0.006);
  EXPECT_LT((products / count - error.covariance).cwiseAbs().maxCoeff(), 0.0026);
}

TEST(Perturbed, AxesWithoutErrorStayExact) {
  const PoseError error(PositioningError::from_deviations({0, 0.1, 0}));
  Random random(9);
  const View commanded = view_towards({1, 2, 3}, {0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    const Vec3 offset = perturbed(commanded, error, random).position() - commanded.position();
    EXPECT_EQ(offset.x(), 0);
    EXPECT_NE(offset.y(), 0);
    EXPECT_EQ(offset.z(), 0);
  }
}

TEST(Perturbed, RefusesWhatIsNoCovariance) {
  PositioningError negative;
  negative.covariance = Vec3(0.01, -0.01, 0.01).asDiagonal();
  PositioningError indefinite;  // correlation above 1
  indefinite.covariance << 0.01, 0.02, 0, 0.02, 0.01, 0, 0, 0, 0.01;
  for (const PositioningError& error : {negative, indefinite}) {
    Random random(1);
    try {
      (void)perturbed(View(), error, random);
      FAIL() << "nothing was thrown";
    } catch (const InputError& complaint) {
      EXPECT_THAT(complaint.what(), HasSubstr("positive semi-definite"));
    }
  }
}

TEST(Perturbed, TurnsTheSensorToo) {
  const PoseError turning = PoseError::from_deviations({0.1, 0.1, 0.1}, {radians(3), 0, radians(1)});
  const PoseError moving(turning.position());
  const View commanded = view_towards({1, 2, 3}, {0, 0, 0});
  Random random(10);
  constexpr int count = 4000;
  Vec3 squares = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    Random same = random;
    const View reached = perturbed(commanded, turning, random);
    EXPECT_EQ(reached.position(), perturbed(commanded, moving, same).position());
    squares += error_between(commanded, reached).tail<3>().cwiseAbs2() / count;
  }
  // The deviations scatter by 1/sqrt(8000) = 1.1 %.
  EXPECT_NEAR(std::sqrt(squares[0]), radians(3), 0.05 * radians(3));
  EXPECT_LT(std::sqrt(squares[1]), 1e-9);
  EXPECT_NEAR(std::sqrt(squares[2]), radians(1), 0.05 * radians(1));
}

class SimulatedRobotTest : public testing::Test {
 protected:
  [[nodiscard]] static SimulatedRobotOptions erring(const Vec3& deviations) {
    return {.error = std::make_shared<ConstantError>(PositioningError::from_deviations(deviations))};
  }
  [[nodiscard]] SimulatedRobot robot(const SimulatedRobotOptions& options, std::uint64_t seed = 1) const {
    return {scanner, small_camera(), options, seed};
  }

  RangeScanner scanner{make_object("sphere")};
  View front = view_towards({2, 0, 0}, {0, 0, 0});
  View side = view_towards({0, 2, 0}, {0, 0, 0});
};

TEST_F(SimulatedRobotTest, WithoutErrorIsWhereItBelieves) {
  SimulatedRobot exact = robot({});
  ASSERT_TRUE(exact.move_to(front));
  EXPECT_EQ(exact.view().position(), front.position());
  EXPECT_EQ(exact.true_view().position(), front.position());
  EXPECT_EQ(exact.take_range_image().depth, scanner.scan(small_camera(), front).depth);
}

TEST_F(SimulatedRobotTest, ScansFromWhereItIsAndBelievesTheCommand) {
  SimulatedRobot erroneous = robot(erring({0.1, 0.1, 0.1}));
  ASSERT_TRUE(erroneous.move_to(front));
  EXPECT_EQ(erroneous.view().position(), front.position());
  EXPECT_GT((erroneous.true_view().position() - front.position()).norm(), 1e-3);
  EXPECT_EQ(erroneous.take_range_image().depth, scanner.scan(small_camera(), erroneous.true_view()).depth);
}

TEST_F(SimulatedRobotTest, ErrsTheMoreTheFartherItGoes) {
  PoseError::Vector per_metre = PoseError::Vector::Zero();
  per_metre[2] = 0.1;
  SimulatedRobot growing = robot({.error = std::make_shared<GrowingError>(PoseError(), per_metre)});
  ASSERT_TRUE(growing.move_to(front));
  EXPECT_EQ(growing.true_view().position(), front.position()) << "no way is known to the first pose";
  ASSERT_TRUE(growing.move_to(front));
  EXPECT_EQ(growing.true_view().position(), front.position());
  ASSERT_TRUE(growing.move_to(side));
  const double far = growing.true_view().position().z() - side.position().z();
  EXPECT_NE(far, 0);
  SimulatedRobot same = robot({.error = std::make_shared<GrowingError>(PoseError(), per_metre)});
  ASSERT_TRUE(same.move_to(front) && same.move_to(front));
  const View near = view_towards({2, 0.1, 0}, {0, 0, 0});
  ASSERT_TRUE(same.move_to(near));
  EXPECT_NEAR((same.true_view().position().z() - near.position().z()) / far, 0.1 / std::sqrt(8.0), 1e-9);
}

TEST_F(SimulatedRobotTest, FirstPoseCanBeExact) {
  SimulatedRobotOptions options = erring({0.1, 0.1, 0.1});
  options.first_pose_exact = true;
  SimulatedRobot erroneous = robot(options);
  ASSERT_TRUE(erroneous.move_to(front));
  EXPECT_EQ(erroneous.true_view().position(), front.position());
  ASSERT_TRUE(erroneous.move_to(side));
  EXPECT_NE(erroneous.true_view().position(), side.position());
}

TEST_F(SimulatedRobotTest, ErrorOfAMoveDependsOnSeedAndNumberAlone) {
  const auto offsets = [&](std::uint64_t seed, const std::vector<View>& commands) {
    SimulatedRobot erroneous = robot(erring({0.1, 0.2, 0.3}), seed);
    std::vector<Vec3> result;
    for (const View& command : commands) {
      EXPECT_TRUE(erroneous.move_to(command));
      result.emplace_back(erroneous.true_view().position() - command.position());
    }
    return result;
  };
  const auto one = offsets(1, {front, side, front});
  const auto other_plan = offsets(1, {side, front, front});
  const auto other_seed = offsets(2, {front, side, front});
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_LT((one[i] - other_plan[i]).norm(), 1e-12);
    EXPECT_GT((one[i] - other_seed[i]).norm(), 1e-3);
  }
  EXPECT_GT((one[0] - one[2]).norm(), 1e-3);  // the same command again, another error
}

TEST_F(SimulatedRobotTest, DrawsAgainWhereItCannotBe) {
  const auto is_above = [](const View& view) { return view.position().z() >= 0; };
  SimulatedRobot limited(scanner, small_camera(), erring({0, 0, 0.1}), 1, is_above);
  SimulatedRobot free = robot(erring({0, 0, 0.1}));
  int below_without_limit = 0;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(limited.move_to(front) && free.move_to(front));
    EXPECT_GE(limited.true_view().position().z(), 0);
    // A draw more in one move leaves the errors of the others as they are.
    if (is_above(free.true_view())) {
      EXPECT_EQ(limited.true_view().position(), free.true_view().position());
    } else {
      ++below_without_limit;
    }
  }
  EXPECT_GT(below_without_limit, 10);
}

TEST_F(SimulatedRobotTest, MovesFailWhereThereIsNoRoom) {
  SimulatedRobot limited(scanner, small_camera(), erring({0.1, 0.1, 0.1}), 1,
                         [&](const View& view) { return view.position().x() == 2 || view.position().x() > 2.05; });
  ASSERT_TRUE(limited.move_to(front));
  EXPECT_FALSE(limited.move_to(side));
  EXPECT_EQ(limited.view().position(), front.position());  // a failed move changes nothing
  EXPECT_GT(limited.true_view().position().x(), 2.05);

  SimulatedRobot hemmed_in(scanner, small_camera(), erring({0.1, 0.1, 0.1}), 1,
                           [&](const View& view) { return view.position() == front.position(); });
  EXPECT_FALSE(hemmed_in.move_to(front));
}

TEST_F(SimulatedRobotTest, NoiseIsOnTheImage) {
  SimulatedRobot noisy_robot = robot({.sensor = {.constant = 0.01}});
  EXPECT_THROW((void)noisy_robot.take_range_image(), InputError);  // it is nowhere yet
  ASSERT_TRUE(noisy_robot.move_to(front));
  const RangeImage exact = scanner.scan(small_camera(), front);
  const RangeImage image = noisy_robot.take_range_image();
  int hits = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    ASSERT_EQ(RangeImage::is_hit(image.depth[i]), RangeImage::is_hit(exact.depth[i]));
    if (!RangeImage::is_hit(image.depth[i])) continue;
    ++hits;
    EXPECT_NE(image.depth[i], exact.depth[i]);
    EXPECT_NEAR(image.depth[i], exact.depth[i], 0.06);
  }
  EXPECT_GT(hits, 40);
}

TEST_F(SimulatedRobotTest, RefusesBadOptions) { EXPECT_THROW(robot({.sensor = {.constant = -1}}), InputError); }

}  // namespace
}  // namespace vantage
