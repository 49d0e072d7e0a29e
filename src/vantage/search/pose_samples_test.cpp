#include "vantage/search/pose_samples.hpp"

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

TEST(PoseSamples, HaveTheErrorsMeanAndCovariance) {
  PoseError error = PoseError::from_deviations({0.1, 0.2, 0}, {radians(3), 0, radians(1)});
  error.covariance(0, 3) = error.covariance(3, 0) = 0.5 * 0.1 * radians(3);
  error.mean << 0.01, 0.02, 0.03, 0.04, 0.05, 0.06;
  const std::vector<PoseSample> samples = pose_samples(error, 32);
  ASSERT_EQ(samples.size(), 32U);
  PoseError::Vector mean = PoseError::Vector::Zero();
  PoseError::Matrix covariance = PoseError::Matrix::Zero();
  double weights = 0;
  for (const PoseSample& each : samples) {
    mean += each.weight * each.error;
    covariance += each.weight * (each.error - error.mean) * (each.error - error.mean).transpose();
    weights += each.weight;
    EXPECT_NEAR(each.error[2], 0.03, 1e-15) << "no error along z";
  }
  EXPECT_NEAR(weights, 1, 1e-12);
  EXPECT_LT((mean - error.mean).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((covariance - error.covariance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PoseSamples, ARobotWithoutVarianceHasOne) {
  PoseError error;
  error.mean[1] = 0.2;
  const std::vector<PoseSample> samples = pose_samples(error, 32);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].error, error.mean);
  EXPECT_EQ(samples[0].weight, 1);
}

}  // namespace
}  // namespace vantage
