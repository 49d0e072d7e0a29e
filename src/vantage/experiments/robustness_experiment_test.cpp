#include <gmock/gmock.h>

#include "vantage/experiments/error_experiments.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

RunResult run_with(double coverage, double views, const std::vector<double>& merged, const std::vector<double>& error) {
  RunOutcome outcome;
  outcome.numbers = {{"coverage", coverage}, {"views", views}, {"refused_scans", 1}, {"recovered_scans", 0}};
  outcome.lists = {{"merged", merged}, {"pose_error", error}, {"merged_at_once", merged}};
  outcome.lists["register_probability"] = std::vector<double>(merged.size(), 0.9);
  outcome.times = {{"plan", {100}}, {"registration", {200}}, {"integration", {300}}};
  return {outcome, "", false};
}

ExperimentOptions small() {
  ExperimentOptions options;
  options.robustness.errors = "0.05:2";
  options.robustness.registrations = "icp,truth";
  options.robustness.seeds = 2;
  return options;
}

TEST(Robustness, CountsRunsThatReachTheGoalAndScansThatAreFarOff) {
  const Experiment experiment = robustness_experiment(small());
  const std::size_t objects = experiment.runs.size() / 4;
  ASSERT_EQ(experiment.runs.size(), 4 * objects);
  ASSERT_GE(objects, 3U);
  std::vector<RunResult> results;
  for (std::size_t i = 0; i < objects; ++i) {
    // The first scan defines the frame and counts for nothing; the last one was never merged.
    results.push_back(run_with(0.995, 8, {1, 1, 1, 0}, {0, 0.001, 0.002, 0.5}));
    results.push_back(run_with(0.8, 6, {1, 1}, {0, 0.03}));
  }
  for (std::size_t i = 0; i < 2 * objects; ++i) results.push_back(run_with(1, 6, {1, 1}, {0, 0}));
  const auto parts = experiment.report(Outcomes(results));
  const auto& table = std::get<ExperimentTable>(parts[0]);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0].name, "5 cm, 2 degrees: icp");
  const auto& cells = table.rows[0].cells;
  ASSERT_EQ(cells.size(), table.columns.size());
  EXPECT_EQ(std::get<std::string>(cells[0]), concat(objects, " of ", 2 * objects));
  EXPECT_NEAR(std::get<Estimate>(cells[3]).mean, 1, 1e-12) << "8 and 6 views, with truth 6";
  EXPECT_EQ(std::get<std::string>(cells[6]), "2.00");
  EXPECT_EQ(std::get<std::string>(cells[8]), "30.00");
  EXPECT_EQ(std::get<std::string>(cells[9]), concat(objects, " of ", 3 * objects));
  const auto& calibration = std::get<ExperimentTable>(parts[2]);
  ASSERT_EQ(calibration.rows.size(), 1U);
  EXPECT_EQ(calibration.rows[0].name, "0.8 to 0.95");
  EXPECT_EQ(std::get<std::string>(calibration.rows[0].cells[0]), concat(4 * objects));
  EXPECT_NEAR(std::get<Estimate>(calibration.rows[0].cells[2]).mean, 75, 1e-9) << "one of four was refused";
  EXPECT_NEAR(std::get<Estimate>(calibration.rows[0].cells[3]).mean, 50, 1e-9) << "and one is 30 mm off";
  EXPECT_NEAR(std::get<Estimate>(std::get<ExperimentTable>(parts[3]).rows[0].cells[0]).mean, 0.6, 1e-12);
}

TEST(Robustness, RefusesWhatIsNoError) {
  RobustnessOptions options;
  options.errors = "0.05";
  try {
    options.validate();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("robustness-errors: '0.05' must be METRES:DEGREES"));
  }
  options.errors = "0.05:2";
  options.registrations = "icp,luck";
  EXPECT_THROW(options.validate(), InputError);
}

TEST(Robustness, SeedsBeginWhereTheOptionsSay) {
  ExperimentOptions options = small();
  options.robustness.first_seed = 101;
  const Experiment experiment = robustness_experiment(options);
  EXPECT_THAT(experiment.runs[0].name, HasSubstr("seed 101"));
  EXPECT_THAT(experiment.runs[1].name, HasSubstr("seed 102"));
}

}  // namespace
}  // namespace vantage
