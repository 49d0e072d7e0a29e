#include "vantage/experiments/experiment.hpp"

#include <gmock/gmock.h>

#include <set>

#include "vantage/experiments/experiments.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/sweep_test_util.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

RunResult with_number(double value) {
  RunOutcome outcome;
  outcome.numbers["value"] = value;
  return {outcome, "", false};
}
const RunResult failed{std::nullopt, "failed", false};

TEST(Outcomes, PairLeavesOutEveryPlaceWhereOneFailed) {
  const Outcomes outcomes({with_number(1), failed, with_number(3), with_number(4),  //
                           with_number(10), with_number(20), with_number(30), failed});
  const auto paired = outcomes.paired({{0, 4}, {4, 4}});
  EXPECT_EQ(numbers(paired[0], "value"), (std::vector<double>{1, 3}));
  EXPECT_EQ(numbers(paired[1], "value"), (std::vector<double>{10, 30}));
  EXPECT_THROW((void)outcomes.paired({{0, 4}, {4, 4}}, 3), Error);
  EXPECT_THROW((void)outcomes.paired({{0, 4}, {4, 3}}), InputError);
}

TEST(Experiments, TellOfFailedRunsAndReportTheOthers) {
  const Count worked = std::make_shared<std::atomic<int>>(0);
  Experiment good("good"), bad("bad");
  (void)good.add({square(2, worked)});
  (void)bad.add({square(13, worked)});
  good.report = [](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable table;
    table.name = "squares";
    table.columns = {{"square"}};
    table.rows = {{"2", {estimate(numbers(outcomes.of({0, 1}), "square"))}}};
    return {table};
  };
  bad.report = [](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    (void)outcomes.of({0, 1});
    return {ExperimentTable()};
  };
  const std::vector<Experiment> both{good, bad};
  const SweepFolder folder;
  const RunStore store(folder.path(), "program");
  SingleRank alone;
  const auto parts = report_parts(both, run_sweep(runs_of(both), store, alone));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(std::get<ExperimentTable>(parts[0]).name, "squares");
  const auto& failures = std::get<ExperimentTable>(parts[1]);
  ASSERT_EQ(failures.rows.size(), 2U);
  EXPECT_EQ(failures.rows[0].name, "bad: square of 13");
  EXPECT_EQ(std::get<std::string>(failures.rows[0].cells[0]), "13 brings bad luck");
  EXPECT_THAT(std::get<std::string>(failures.rows[1].cells[0]), HasSubstr("no report: 0 of 1 runs"));
}

TEST(Experiments, EqualRunsOfDifferentTablesAreShared) {
  ExperimentOptions options;
  options.starts = 4;
  std::set<std::string> different;
  std::size_t all = 0;
  for (const char* name : {"table2", "table4"}) {
    for (const SweepRun& run : runs_of(make_experiments(name, options))) {
      different.insert(run.configuration);
      ++all;
    }
  }
  EXPECT_EQ(3 * different.size(), 2 * all);  // table 4 has the runs of table 2, and as many without navigation
}

TEST(Experiments, RunsWithSeedsStartAlikeForEveryMethod) {
  const auto sphere = paper_object("sphere", std::nullopt).object;
  ReconstructOptions one, other;
  other.utility = "gua";
  const auto first = runs_with_seeds("one", sphere, one, 5), second = runs_with_seeds("other", sphere, other, 5);
  ASSERT_EQ(first.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    std::string expected = first[i].configuration;
    expected.replace(expected.find("combined"), 8, "gua");
    EXPECT_EQ(second[i].configuration, expected);
  }
}

TEST(Experiments, SayWhatIsWrongWithOptions) {
  const auto with = [](const auto& change) {
    ExperimentOptions options;
    change(options);
    return options;
  };
  const auto message = [](const std::string& name, const ExperimentOptions& options) -> std::string {
    try {
      (void)make_experiments(name, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("table7", {}), HasSubstr("'table7' is unknown; must be one of: table1"));
  EXPECT_THAT(message("tabel1", {}), HasSubstr("did you mean 'table1'?"));
  EXPECT_THAT(message("table1", with([](auto& o) { o.objects = "/nowhere"; })),
              HasSubstr("objects = '/nowhere': must be a folder"));
  EXPECT_THAT(message("table1", with([](auto& o) { o.starts = 1; })), HasSubstr("starts = 1: must be in 2..80"));
  EXPECT_THAT(message("table1", with([](auto& o) { o.starts = 81; })), HasSubstr("starts = 81"));
  EXPECT_THAT(message("figure11", with([](auto& o) { o.seeds = 0; })), HasSubstr("seeds = 0: must be in 2"));
}

}  // namespace
}  // namespace vantage
