#include "vantage/robot/pose_error.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/robot/error_model.hpp"

namespace vantage {
namespace {

/// At (2,0,0), looking along -x: right is +y, down is -z.
const View commanded = view_towards({2, 0, 0}, {0, 0, 0});

PoseError::Vector error_of(int entry, double value) {
  PoseError::Vector error = PoseError::Vector::Zero();
  error[entry] = value;
  return error;
}

TEST(PoseError, PanTiltAndRollTurnAboutTheSensorsAxes) {
  const double angle = radians(10);
  // Turning about an axis by the right-hand rule takes z to x about y, y to z about x, x to y about z.
  const View panned = displaced(commanded, error_of(3, angle));
  EXPECT_TRUE(panned.axis().isApprox(Vec3(-std::cos(angle), std::sin(angle), 0), 1e-12)) << "panned to the right";
  const View tilted = displaced(commanded, error_of(4, angle));
  EXPECT_TRUE(tilted.axis().isApprox(Vec3(-std::cos(angle), 0, std::sin(angle)), 1e-12)) << "tilted up";
  const View rolled = displaced(commanded, error_of(5, angle));
  EXPECT_TRUE(rolled.axis().isApprox(commanded.axis(), 1e-12));
  EXPECT_TRUE(rolled.world_from_sensor.linear().col(0).isApprox(Vec3(0, std::cos(angle), -std::sin(angle)), 1e-12));
  for (const View& turned : {panned, tilted, rolled}) {
    EXPECT_EQ(turned.position(), commanded.position());
    EXPECT_NEAR(rotation_angle(turned.world_from_sensor.linear(), commanded.world_from_sensor.linear()), angle, 1e-12);
  }
}

TEST(PoseError, MovesInTheWorldFrame) {
  PoseError::Vector error;
  error << 0.1, -0.2, 0.3, 0, 0, 0;
  const View moved = displaced(commanded, error);
  EXPECT_TRUE(moved.position().isApprox(Vec3(2.1, -0.2, 0.3)));
  EXPECT_EQ(moved.world_from_sensor.linear(), commanded.world_from_sensor.linear());
}

TEST(PoseError, IsFoundAgainFromBothPoses) {
  Random random(4);
  int cases = 0;
  for (int i = 0; i < 200; ++i, ++cases) {
    const View view = view_towards(3 * random.unit_vector(), 0.2 * random.normal3());
    PoseError::Vector error;
    error << 0.3 * random.normal3(), 0.3 * random.normal3();
    EXPECT_TRUE(error_between(view, displaced(view, error)).isApprox(error, 1e-9)) << error.transpose();
  }
  EXPECT_EQ(cases, 200);
  EXPECT_LT(error_between(commanded, commanded).norm(), 1e-7);
}

TEST(PoseError, HoldsThePositionAlone) {
  PositioningError position = PositioningError::from_deviations({0.1, 0.2, 0.3});
  position.mean = {1, 2, 3};
  const PoseError error(position);
  EXPECT_TRUE(error.keeps_orientation());
  EXPECT_EQ(error.position().mean, position.mean);
  EXPECT_EQ(error.position().covariance, position.covariance);
  EXPECT_FALSE(PoseError::from_deviations(Vec3::Zero(), {0, 0, 0.01}).keeps_orientation());
  EXPECT_TRUE(PoseError().is_zero());
}

TEST(PoseError, RootsGiveTheCovarianceBack) {
  Random random(7);
  for (int rank = 1; rank <= 6; ++rank) {
    Eigen::MatrixXd factor(6, rank);
    for (int i = 0; i < factor.size(); ++i) factor.data()[i] = random.normal();
    const Eigen::MatrixXd covariance = factor * factor.transpose();
    const Eigen::MatrixXd root = root_of(covariance);
    EXPECT_TRUE((root * root.transpose()).isApprox(covariance, 1e-9)) << "rank " << rank;
  }
  const Eigen::MatrixXd diagonal = Vec3(4, 0, 9).asDiagonal();
  EXPECT_EQ(root_of(diagonal), Eigen::MatrixXd(Vec3(2, 0, 3).asDiagonal()));
}

TEST(PoseError, NamesWhatIsWrong) {
  EXPECT_THROW((void)PoseError::from_deviations(Vec3::Zero(), {0, -0.1, 0}), InputError);
  EXPECT_THROW((void)PoseError::from_deviations({0, -0.1, 0}, Vec3::Zero()), InputError);
  PoseError error;
  error.covariance(0, 3) = error.covariance(3, 0) = 0.1;  // correlation without variances
  EXPECT_THROW(error.validate(), InputError);
  error = {};
  error.covariance(0, 3) = 0.1;
  EXPECT_THROW(error.validate(), InputError);
  error = {};
  error.mean[5] = std::nan("");
  EXPECT_THROW(error.validate(), InputError);
}

TEST(PoseError, RefusesErrorsThatNoRobotHas) {
  for (const double absurd : {1e20, 1e9, 1e300}) {
    EXPECT_THROW((void)PositioningError::from_deviations(Vec3(absurd, 0, 0)), InputError);
    PoseError error;
    error.mean[1] = absurd;
    EXPECT_THROW(error.validate(), InputError);
    error = {};
    error.covariance(2, 2) = absurd;
    if (absurd > 1e12) {
      EXPECT_THROW(error.validate(), InputError);
    }
    error = {};
    error.covariance(4, 4) = absurd;
    EXPECT_THROW(error.validate(), InputError);
    EXPECT_THROW((void)PoseError::from_deviations(Vec3::Zero(), Vec3(0, absurd, 0)), InputError);
    EXPECT_THROW(GrowingError(PoseError(), PoseError::Vector::Constant(absurd)), InputError);
    EXPECT_THROW(TurntableArmError({.azimuth = absurd}, Vec3::Zero()), InputError);
  }
  EXPECT_NO_THROW(PoseError::from_deviations(Vec3(10, 0, 0), Vec3(0, radians(180), 0)).validate());
}

}  // namespace
}  // namespace vantage
