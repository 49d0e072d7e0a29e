#include "vantage/core/fixed_point.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(FixedPoint, KnownValues) {
  EXPECT_EQ(to_fixed_point(0), 0);
  EXPECT_EQ(to_fixed_point(1), 1 << 30);
  EXPECT_EQ(to_fixed_point(-0.5), -(1 << 29));
  EXPECT_EQ(to_fixed_point(0x1.8p-30), 2);  // ties go to even
  EXPECT_EQ(to_fixed_point(0x0.8p-30), 0);
  EXPECT_EQ(from_fixed_point(3 << 28), 0.75);
}

TEST(FixedPoint, RoundTripIsWithinHalfAStep) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform(-1, 1);
    EXPECT_LE(std::abs(from_fixed_point(to_fixed_point(value)) - value), 0x1p-31);
  }
}

TEST(FixedPoint, AnyOrderOfAddingGivesTheSameSum) {
  Random random(2);
  std::vector<double> values(10000);
  for (double& value : values) value = random.uniform();
  std::int64_t forwards = 0;
  std::int64_t backwards = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    forwards += to_fixed_point(values[i]);
    backwards += to_fixed_point(values[values.size() - 1 - i]);
  }
  EXPECT_EQ(forwards, backwards);
  EXPECT_NEAR(from_fixed_point(forwards), 5000, 100);
}

}  // namespace
}  // namespace vantage
