#include "vantage/robot/error_model.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(GrowingError, DeviatesByAPlusBTimesTheDistance) {
  PoseError::Vector per_metre;
  per_metre << 0.01, 0, 0.02, radians(1), 0, 0;
  const GrowingError model(PoseError::from_deviations({0.02, 0.03, 0}, {0, 0, radians(2)}), per_metre);
  const View from = view_towards({0, 0, 3}, {0, 0, 0});
  const View to = view_towards({4, 0, 0}, {0, 0, 0});  // 5 m away
  PoseError::Vector expected;
  expected << 0.07, 0.03, 0.1, radians(5), 0, radians(2);
  const PoseError error = model.of_move(from, to);
  EXPECT_TRUE(error.covariance.diagonal().cwiseSqrt().isApprox(expected, 1e-12));
  EXPECT_TRUE(model.of_move(to, to).covariance.diagonal().cwiseSqrt().isApprox(
      (PoseError::Vector() << 0.02, 0.03, 0, 0, 0, radians(2)).finished(), 1e-12));
  EXPECT_FALSE(model.is_constant());
}

TEST(ConstantError, IsTheSameForEveryMove) {
  const ConstantError model(PoseError::from_deviations({0.1, 0.2, 0.3}, {0.01, 0.02, 0.03}));
  const View here = view_towards({2, 0, 0}, {0, 0, 0});
  const View there = view_towards({0, 2, 0}, {0, 0, 0});
  EXPECT_EQ(model.of_move(here, there).covariance, model.of_move(there, here).covariance);
  EXPECT_TRUE(model.is_constant());
}

/// Moves the arm itself instead of using derivatives.
View turned_arm(const View& view, const Vec3& center, double azimuth, double elevation, double reach) {
  const Vec3 arm = view.position() - center;
  const Vec3 axis = Vec3::UnitZ().cross(arm).normalized();
  const Mat3 turn = (Eigen::AngleAxisd(azimuth, Vec3::UnitZ()) * Eigen::AngleAxisd(elevation, axis)).toRotationMatrix();
  View moved;
  moved.world_from_sensor.linear() = turn * view.world_from_sensor.linear();
  moved.world_from_sensor.translation() = center + turn * (arm + reach * arm.normalized());
  return moved;
}

TEST(TurntableArmError, IsWhatSmallTurnsOfTheArmDo) {
  Random random(11);
  const Vec3 center(0.1, 0.2, 0.3);
  const TurntableArmError::Deviations deviations{1e-5, 2e-5, 3e-5};
  const TurntableArmError model(deviations, center);
  int cases = 0;
  for (int i = 0; i < 20; ++i, ++cases) {
    const View view = view_towards(center + 2 * random.unit_vector(), center);
    PoseError::Matrix expected = PoseError::Matrix::Zero();
    for (const View& moved :
         {turned_arm(view, center, deviations.azimuth, 0, 0), turned_arm(view, center, 0, deviations.elevation, 0),
          turned_arm(view, center, 0, 0, deviations.reach)}) {
      const PoseError::Vector error = error_between(view, moved);
      expected += error * error.transpose();
    }
    const PoseError error = model.of_move(view, view);
    EXPECT_TRUE(error.covariance.isApprox(expected, 1e-3)) << error.covariance << "\n\n" << expected;
    EXPECT_NO_THROW(error.validate());
  }
  EXPECT_EQ(cases, 20);
}

TEST(TurntableArmError, ByHandOnTheEquator) {
  // 2 m from the table's axis, 1 degree of the table: 2 m * 0.01745 sideways and as much pan; nothing else.
  const TurntableArmError model({radians(1), 0, 0}, Vec3::Zero());
  const View view = view_towards({2, 0, 0}, {0, 0, 0});
  const PoseError::Vector deviations = model.of_move(view, view).covariance.diagonal().cwiseSqrt();
  PoseError::Vector expected = PoseError::Vector::Zero();
  expected[1] = 2 * radians(1);
  expected[3] = radians(1);
  EXPECT_LT((deviations - expected).cwiseAbs().maxCoeff(), 1e-12) << deviations.transpose();
}

TEST(ErrorModels, NameWhatIsWrong) {
  PoseError::Vector per_metre = PoseError::Vector::Zero();
  per_metre[2] = -0.1;
  EXPECT_THROW(GrowingError({}, per_metre), InputError);
  PositioningError correlated;
  correlated.covariance << 1, 0.5, 0, 0.5, 1, 0, 0, 0, 1;
  EXPECT_THROW(GrowingError(correlated, PoseError::Vector::Zero()), InputError);
  EXPECT_THROW(TurntableArmError({0, -1, 0}, Vec3::Zero()), InputError);
}

}  // namespace
}  // namespace vantage
