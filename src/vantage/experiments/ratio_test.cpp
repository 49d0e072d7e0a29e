#include "vantage/experiments/ratio.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

TEST(RatioOfMeans, IsThatOfAHandCalculation) {
  // Differences 1, 3: mean 2, standard deviation sqrt(2), standard error 1; Student's value for one degree is 12.7062.
  const Estimate ratio = ratio_of_means({11, 33}, {10, 30});
  EXPECT_DOUBLE_EQ(ratio.mean, 1.1);
  EXPECT_NEAR(ratio.sd, std::sqrt(2.0) / 20, 1e-12);
  EXPECT_NEAR(ratio.low, 1.1 - 12.7062 / 20, 1e-5);
  EXPECT_NEAR(ratio.high, 1.1 + 12.7062 / 20, 1e-5);
  EXPECT_EQ(ratio.runs, 2);
}

TEST(RatioOfMeans, RefusesToDivideByZeroAndToPairUnequalLists) {
  EXPECT_THROW((void)ratio_of_means({1, 2}, {-1, 1}), InputError);
  EXPECT_THROW((void)ratio_of_means({1, 2, 3}, {1, 2}), InputError);
}

}  // namespace
}  // namespace vantage
