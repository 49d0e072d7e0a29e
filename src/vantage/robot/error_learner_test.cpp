#include "vantage/robot/error_learner.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

const View commanded = view_towards({2, 0, 0}, {0, 0, 0});

PoseError::Vector error_at(const Vec3& position, const Vec3& orientation = Vec3::Zero()) {
  PoseError::Vector error;
  error << position, orientation;
  return error;
}

double deviation(const PoseError& error) { return std::sqrt(error.covariance.topLeftCorner<3, 3>().trace() / 3); }

TEST(ErrorLearner, BelievesThePriorBeforeTheFirstScan) {
  const ErrorLearner learner;
  EXPECT_TRUE(learner.estimate().mean.isZero(0));
  EXPECT_NEAR(deviation(learner.estimate()), 0.05, 1e-15);
  EXPECT_NEAR(learner.estimate().covariance(4, 4), radians(1) * radians(1), 1e-15);
}

TEST(ErrorLearner, ByHandForTwoScans) {
  // Differences (0.2,0,0) and (0.4,0,0); kappa_0 = 1, prior deviation 0.05 worth one scan.
  ErrorLearner learner;
  learner.add(commanded, displaced(commanded, error_at({0.2, 0, 0})));
  learner.add(commanded, displaced(commanded, error_at({0.4, 0, 0})));
  const PoseError error = learner.estimate();
  EXPECT_NEAR(error.mean[0], 0.6 / 3, 1e-12);
  // (0.0025 + scatter 0.02 + 2/3 * 0.3^2) / (1 + 2)
  EXPECT_NEAR(error.covariance(0, 0), (0.0025 + 0.02 + 0.06) / 3, 1e-12);
  EXPECT_NEAR(error.covariance(1, 1), 0.0025 / 3, 1e-12);
  EXPECT_NEAR(error.covariance(0, 1), 0, 1e-12);
  EXPECT_NEAR(learner.prediction().covariance(0, 0), error.covariance(0, 0) * 4 / 3, 1e-12);
}

TEST(ErrorLearner, FindsMeanCovarianceAndOrientationOfARobot) {
  PoseError truth = PoseError::from_deviations({0.1, 0.1, 0.02}, {radians(3), radians(1), radians(2)});
  truth.covariance(0, 1) = truth.covariance(1, 0) = 0.006;
  truth.mean = error_at({0.05, 0, -0.03}, {0, radians(2), 0});
  const Eigen::MatrixXd root = root_of(truth.covariance);
  Random random(5);
  ErrorLearner learner;
  for (int i = 0; i < 2000; ++i) {
    const View view = view_towards(2 * random.unit_vector(), Vec3::Zero());
    Eigen::VectorXd normal(6);
    for (double& each : normal) each = random.normal();
    learner.add(view, displaced(view, truth.mean + root * normal));
  }
  const PoseError error = learner.estimate();
  // Deviations scatter by 1/sqrt(4000) = 1.6 %, means by sigma/sqrt(2000) = 2.2 % of it: limits at four times that.
  for (int i = 0; i < 6; ++i) {
    const double sigma = std::sqrt(truth.covariance(i, i));
    EXPECT_NEAR(std::sqrt(error.covariance(i, i)) / sigma, 1, 0.064) << i;
    EXPECT_NEAR(error.mean[i], truth.mean[i], 0.09 * sigma) << i;
  }
  EXPECT_NEAR(error.covariance(0, 1), 0.006, 0.0011);
  EXPECT_LE(learner.left_out(), 1);
}

TEST(ErrorLearner, IsWithin30PerCentAfterTenScansForMostSeeds) {
  int close = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    ErrorLearner learner;
    for (int i = 0; i < 10; ++i) learner.add(commanded, displaced(commanded, error_at(0.1 * random.normal3())));
    close += std::abs(deviation(learner.estimate()) / 0.1 - 1) < 0.3 ? 1 : 0;
  }
  EXPECT_GE(close, 180);
}

TEST(ErrorLearner, LeavesOutRegistrationsThatAreWildlyWrong) {
  Random random(6);
  ErrorLearner clean;
  ErrorLearner disturbed;
  disturbed.add(commanded, displaced(commanded, error_at({1.5, 0, 0}, {0, 0, radians(120)})));
  for (int i = 0; i < 9; ++i) {
    const View reached = displaced(commanded, error_at(0.1 * random.normal3()));
    clean.add(commanded, reached);
    disturbed.add(commanded, reached);
    if (i == 4) disturbed.add(commanded, displaced(commanded, error_at({0, -2, 1})));
  }
  EXPECT_EQ(clean.left_out(), 0);
  EXPECT_EQ(disturbed.left_out(), 2);
  EXPECT_TRUE(disturbed.estimate().covariance.isApprox(clean.estimate().covariance, 1e-9));
  EXPECT_TRUE(disturbed.estimate().mean.isApprox(clean.estimate().mean, 1e-9));
}

TEST(ErrorLearner, DoesNotTakeALargeErrorForAWildOne) {
  // A robot ten times worse than the prior believes: nothing may lock its scans out for good.
  int left_out = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    ErrorLearner learner;
    for (int i = 0; i < 20; ++i) learner.add(commanded, displaced(commanded, error_at(0.5 * random.normal3())));
    left_out += learner.left_out();
  }
  EXPECT_LE(left_out, 4) << "of 400";
}

TEST(ErrorLearner, NamesWhatIsWrong) {
  ErrorLearnerOptions options;
  options.prior_deviation.y() = 0;
  EXPECT_THROW((void)ErrorLearner(options), InputError);
  options = {};
  options.wild_deviations = -1;
  EXPECT_THROW((void)ErrorLearner(options), InputError);
}

}  // namespace
}  // namespace vantage
