#include "vantage/experiments/compare_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

RunOutcome outcome(std::vector<double> coverage) {
  RunOutcome result;
  result.lists["coverage"] = std::move(coverage);
  result.lists["distance"] = {0, 2, 5, 9};
  result.lists["overlap"] = {0, 0.4, 0.2, 0.1};
  result.numbers["accuracy"] = 0.002;
  return result;
}

TEST(CompareMeasures, CountScansUpToTheGoals) {
  const CompareMeasures run = measure_run(outcome({0.5, 0.96, 0.991, 0.995}), 25, "coverage");
  EXPECT_EQ(run.views, (std::array<double, 4>{2, 2, 3, 3}));
  EXPECT_EQ(run.distance, 5);
  EXPECT_EQ(run.seconds, 3 * 3 + 5 / 0.5);
  EXPECT_EQ(run.missed, 0);
  EXPECT_EQ(run.min_overlap, 0.2) << "the fourth scan came after the goal";
  EXPECT_DOUBLE_EQ(run.mean_overlap, 0.3);
  // 0.5, 0.96, 0.991 and 0.995 carried on to the 20th scan.
  EXPECT_NEAR(run.area_under_curve, 100 * (0.5 + 0.96 + 0.991 + 17 * 0.995) / 20, 1e-9);
}

TEST(CompareMeasures, CountTheRobotsTimeForScansAndPath) {
  const RobotTime slow{.scan = 10, .speed = 0.25};
  EXPECT_EQ(measure_run(outcome({0.5, 0.96, 0.991, 0.995}), 25, "coverage", slow).seconds, 3 * 10 + 5 / 0.25);
  EXPECT_THROW((RobotTime{.scan = -1}.validate()), InputError);
  EXPECT_THROW((RobotTime{.speed = 0}.validate()), InputError);
}

TEST(CompareMeasures, CountTheBudgetWhereAGoalIsMissed) {
  const CompareMeasures run = measure_run(outcome({0.5, 0.8, 0.91, 0.92}), 25, "coverage");
  EXPECT_EQ(run.views, (std::array<double, 4>{3, 25, 25, 25}));
  EXPECT_EQ(run.distance, 9);
  EXPECT_EQ(run.missed, 1);
  EXPECT_EQ(run.seconds, 25 * 3 + 9 / 0.5);
  EXPECT_EQ(run.min_overlap, 0.1);
}

TEST(CompareMeasures, PassOverScansThatWereNotMerged) {
  RunOutcome run = outcome({0.5, 0.5, 0.7, 0.8});
  run.lists["overlap"] = {std::nan(""), std::nan(""), 0.3, 0.2};
  EXPECT_DOUBLE_EQ(measure_run(run, 25, "coverage").mean_overlap, 0.25);
}

TEST(CompareMeasures, AreSummedOverObjects) {
  CompareMeasures a, b;
  a.views = {1, 2, 3, 4};
  b.views = {10, 20, 30, 40};
  a.min_overlap = 0.3;
  b.min_overlap = 0.2;
  a.accuracy = 1;
  b.accuracy = 3;
  const CompareMeasures sum = over_objects({a, b});
  EXPECT_EQ(sum.views, (std::array<double, 4>{11, 22, 33, 44}));
  EXPECT_EQ(sum.min_overlap, 0.2);
  EXPECT_EQ(sum.accuracy, 2);
}

TEST(CompareMeasures, ShareRanksAmongEquals) {
  EXPECT_EQ(ranks_of({5, 4, 5, 9}), (std::vector<double>{2.5, 1, 2.5, 4}));
}

}  // namespace
}  // namespace vantage
