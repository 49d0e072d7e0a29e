#include "vantage/core/normal_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(NormalQuantile, IsTheTablesOfStatistics) {
  EXPECT_EQ(normal_quantile(0.5), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(0.1), -1.2815515655446004, 1e-12);
  EXPECT_NEAR(normal_quantile(1e-6), -4.753424308822899, 1e-9);
}

TEST(NormalPoints, HaveMeanZeroAndUnitCovariance) {
  int cases = 0;
  for (int d = 1; d <= 6; ++d) {
    for (const int count : {12, 32, 200}) {
      const Eigen::MatrixXd points = normal_points(d, count);
      ASSERT_EQ(points.cols(), count);
      EXPECT_LT(points.rowwise().sum().cwiseAbs().maxCoeff(), 1e-12);
      const Eigen::MatrixXd covariance = points * points.transpose() / count;
      EXPECT_LT((covariance - Eigen::MatrixXd::Identity(d, d)).cwiseAbs().maxCoeff(), 1e-12);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 18);
  EXPECT_THROW((void)normal_points(6, 10), InputError);
  EXPECT_THROW((void)normal_points(2, 31), InputError);
}

TEST(NormalPoints, AverageASmoothFunctionBetterThanRandomOnes) {
  // The mean of cos(a.z) over a standard normal z is exp(-|a|^2/2).
  Random random(3);
  double ours = 0;
  double drawn = 0;
  constexpr int cases = 200;
  const Eigen::MatrixXd points = normal_points(6, 32);
  for (int i = 0; i < cases; ++i) {
    Eigen::VectorXd a(6);
    for (double& each : a) each = 0.5 * random.normal();
    const double exact = std::exp(-0.5 * a.squaredNorm());
    double sum = 0;
    double random_sum = 0;
    for (int k = 0; k < 32; ++k) {
      sum += std::cos(a.dot(points.col(k))) / 32;
      Eigen::VectorXd z(6);
      for (double& each : z) each = random.normal();
      random_sum += std::cos(a.dot(z)) / 32;
    }
    ours += std::abs(sum - exact) / cases;
    drawn += std::abs(random_sum - exact) / cases;
  }
  EXPECT_LT(ours, 0.75 * drawn) << ours << " " << drawn;
}

}  // namespace
}  // namespace vantage
