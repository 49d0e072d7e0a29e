#include "vantage/search/pose_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

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
