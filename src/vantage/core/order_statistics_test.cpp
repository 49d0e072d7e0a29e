#include "vantage/core/order_statistics.hpp"

#include <gtest/gtest.h>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(OrderStatistics, OfFewValues) {
  EXPECT_EQ(upper_median(std::vector<int>{7}), 7);
  EXPECT_EQ(upper_median(std::vector<int>{9, 1}), 9);
  EXPECT_EQ(median({9, 1}), 5);
  EXPECT_EQ(median({3, 9, 1}), 3);
  EXPECT_EQ(lower_quantile({5, 1, 4, 2, 3}, 0.5), 3);
  EXPECT_EQ(lower_quantile({5, 1, 4, 2, 3}, 0.99), 4) << "rounded down";
  EXPECT_EQ(sorted_quantile({1, 2, 3, 4}, 0), 1);
  EXPECT_EQ(sorted_quantile({1, 2, 3, 4}, 0.5), 2);
  EXPECT_EQ(sorted_quantile({1, 2, 3, 4}, 0.51), 3);
  EXPECT_EQ(sorted_quantile({1, 2, 3, 4}, 1), 4);
}

TEST(OrderStatistics, HalfOfTheValuesAreOnEitherSide) {
  Random random(3);
  int cases = 0;
  for (std::size_t count = 1; count < 60; ++count) {
    std::vector<double> values(count);
    for (double& each : values) each = std::floor(20 * random.uniform());
    for (const double middle : {median(values), upper_median(values), lower_quantile(values, 0.5)}) {
      const auto below = std::count_if(values.begin(), values.end(), [&](double each) { return each < middle; });
      const auto above = std::count_if(values.begin(), values.end(), [&](double each) { return each > middle; });
      EXPECT_LE(2 * below, static_cast<std::ptrdiff_t>(count) + 1);
      EXPECT_LE(2 * above, static_cast<std::ptrdiff_t>(count) + 1);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 3 * 59);
}

}  // namespace
}  // namespace vantage
