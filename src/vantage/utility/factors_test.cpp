#include "vantage/utility/factors.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

// The printed coefficients of eqs 5 and 6, which the code writes in another form.
double printed_h1(double x, double a) { return -2 / (a * a * a) * x * x * x + 3 / (a * a) * x * x; }
double printed_h2(double x, double a) {
  const double c = (a - 1) * (a - 1) * (a - 1);
  return -2 / c * x * x * x + 3 * (a + 1) / c * x * x - 6 * a / c * x + (3 * a - 1) / c;
}

TEST(DesiredShare, IsThePrintedPolynomial) {
  int cases = 0;
  for (double alpha = 0.05; alpha < 1; alpha += 0.05) {
    for (double x = 0; x <= 1; x += 0.01) {
      const double printed = x <= alpha ? printed_h1(x, alpha) : printed_h2(x, alpha);
      EXPECT_NEAR(desired_share(x, alpha), printed, 1e-9) << "x = " << x << ", alpha = " << alpha;
      ++cases;
    }
  }
  EXPECT_GT(cases, 1800);
}

TEST(DesiredShare, MeetsTheConstraintsOfEquation2) {
  EXPECT_DOUBLE_EQ(desired_share(0.2, 0.2), 1);
  EXPECT_DOUBLE_EQ(desired_share(0, 0.2), 0);
  EXPECT_DOUBLE_EQ(desired_share(1, 0.2), 0);
  EXPECT_DOUBLE_EQ(desired_share(0.1, 0.2), 0.5);  // half way up
  EXPECT_DOUBLE_EQ(desired_share(0.6, 0.2), 0.5);  // half way down
}

TEST(DesiredShare, UsesTheBranchThatRemainsAtTheEnds) {
  EXPECT_DOUBLE_EQ(desired_share(0, 0), 1);
  EXPECT_DOUBLE_EQ(desired_share(0.5, 0), 0.5);
  EXPECT_DOUBLE_EQ(desired_share(1, 0), 0);
  EXPECT_DOUBLE_EQ(desired_share(0, 1), 0);
  EXPECT_DOUBLE_EQ(desired_share(0.5, 1), 0.5);
  EXPECT_DOUBLE_EQ(desired_share(1, 1), 1);
}

TEST(NavigationFactor, FallsFromOneToRho) {
  EXPECT_DOUBLE_EQ(navigation_factor(0, 0.2), 1);
  EXPECT_DOUBLE_EQ(navigation_factor(1, 0.2), 0.2);
  EXPECT_DOUBLE_EQ(navigation_factor(0.5, 0.2), 0.8);  // 1 - 0.8/4
}

Visibility seen(int occupied, int occplane, int unmarked, double cosine_sum) {
  Visibility visibility;
  visibility.rays = 1000;
  visibility.occupied = occupied;
  visibility.occplane = occplane;
  visibility.unmarked = unmarked;
  visibility.occluded = 77;  // counts in nothing
  visibility.cosine_sum = to_fixed_point(cosine_sum);
  return visibility;
}

TEST(Factors, AreThePapersByHand) {
  // 20 occupied, 70 occplane, 10 unmarked: x_oc = 0.2, x_op = 0.7.
  const Factors f = factors(seen(20, 70, 10, 15), 0.5, {});
  EXPECT_DOUBLE_EQ(f.x_oc, 0.2);
  EXPECT_DOUBLE_EQ(f.x_op, 0.7);
  // f(0.2, 0.2) = 1; f(0.7, 0.8) = s^2 (3 - 2s) with s = 7/8: 0.765625 * 1.25 = 0.95703125.
  EXPECT_NEAR(f.f_area, 1.95703125, 1e-12);
  EXPECT_NEAR(f.f_quality, 0.75, 1e-8);
  EXPECT_DOUBLE_EQ(f.f_occlusion, 0.07);
  EXPECT_DOUBLE_EQ(f.f_navigation, 0.8);
  EXPECT_NEAR(combined_utility(f), 1.95703125 * (0.75 + 0.8 + 0.07), 1e-7);
  EXPECT_DOUBLE_EQ(gua_utility(f), 0.07);
}

TEST(Factors, AreDefinedWhereNothingIsSeen) {
  const Factors nothing = factors(seen(0, 0, 0, 0), 0.3, {});
  EXPECT_EQ(combined_utility(nothing), 0);
  EXPECT_EQ(gua_utility(nothing), 0);
  const Factors no_occupied = factors(seen(0, 50, 50, 0), 0, {});
  EXPECT_EQ(no_occupied.f_quality, 0);
  EXPECT_GT(combined_utility(no_occupied), 0);
}

TEST(Factors, LeaveNavigationOutWhereAsked) {
  UtilityOptions options;
  options.navigation = false;
  EXPECT_EQ(factors(seen(20, 70, 10, 15), 0, options).f_navigation, 0);
}

TEST(UtilityOptions, NameTheBadValue) {
  UtilityOptions options;
  options.alpha_oc = 1.5;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.rho = 1;
  EXPECT_THROW(
      {
        try {
          options.validate();
        } catch (const InputError& error) {
          EXPECT_STREQ(error.what(), "rho = 1: must be in [0, 1)");
          throw;
        }
      },
      InputError);
}

}  // namespace
}  // namespace vantage
