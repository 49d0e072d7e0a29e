#include "vantage/experiments/estimate.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Estimate, OfAWorkedExample) {
  // Mean 5, squared deviations 9 1 1 1 0 0 4 16 = 32 over 7; t(7) = 2.36462 as printed in tables.
  const Estimate result = estimate({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(result.runs, 8);
  EXPECT_DOUBLE_EQ(result.mean, 5);
  EXPECT_NEAR(result.sd, 2.13809, 1e-5);
  EXPECT_NEAR(result.low, 5 - 2.36462 * 2.13809 / std::sqrt(8), 1e-5);
  EXPECT_NEAR(result.high, 5 + 2.36462 * 2.13809 / std::sqrt(8), 1e-5);
}

TEST(Estimate, OfOneValueIsThatValue) {
  const Estimate result = estimate({3.5});
  EXPECT_EQ(result.mean, 3.5);
  EXPECT_EQ(result.sd, 0);
  EXPECT_EQ(result.low, 3.5);
  EXPECT_EQ(result.high, 3.5);
}

TEST(Estimate, RefusesWhatHasNoMean) {
  EXPECT_THAT([] { static_cast<void>(estimate({})); }, ThrowsMessage<InputError>(HasSubstr("no values")));
  EXPECT_THAT(
      [] {
        static_cast<void>(estimate({1, NAN}));
      },
      ThrowsMessage<InputError>(HasSubstr("value 1 of 2 is nan")));
}

TEST(PairedDifference, ForgetsWhatThePairsShare) {
  const Estimate result = paired_difference({10, 200, 3000}, {11, 202, 3003});
  EXPECT_DOUBLE_EQ(result.mean, 2);
  EXPECT_DOUBLE_EQ(result.sd, 1);
  EXPECT_THAT(
      [] {
        static_cast<void>(paired_difference({1}, {1, 2}));
      },
      ThrowsMessage<InputError>(HasSubstr("of 1 and 2 values")));
}

TEST(Student, HasTheQuantilesOfTheTables) {
  const std::pair<int, double> table[] = {{1, 12.7062},  {2, 4.30265},  {4, 2.77645},   {9, 2.26216},
                                          {19, 2.09302}, {30, 2.04227}, {120, 1.97993}, {100000, 1.95999}};
  for (const auto& [n, value] : table) EXPECT_NEAR(student_975(n), value, 5e-5 * value) << n;
}

TEST(Estimate, KnowsItsBand) {
  Estimate value = estimate({1, 3});
  EXPECT_FALSE(value.in_band().has_value());
  value.band_low = 2.5;
  EXPECT_EQ(value.in_band(), false);
  value.band_low = 1.5;
  EXPECT_EQ(value.in_band(), true);
  value.band_high = 1.9;
  EXPECT_EQ(value.in_band(), false);
}

}  // namespace
}  // namespace vantage
