#include "vantage/experiments/sweep.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <deque>
#include <mutex>
#include <thread>

#include "vantage/experiments/sweep_test_util.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

Count counter() { return std::make_shared<std::atomic<int>>(0); }

std::vector<RunResult> run_alone(const std::vector<SweepRun>& runs, const SweepFolder& folder,
                                 const SweepControl& control = {}) {
  const RunStore store(folder.path(), "program");
  SingleRank alone;
  return run_sweep(runs, store, alone, control);
}

void expect_squares(const std::vector<RunResult>& results, std::size_t count) {
  ASSERT_EQ(results.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(results[i].outcome.has_value(), i != 13) << i;
    if (i == 13) continue;
    EXPECT_EQ(results[i].outcome->number("square"), static_cast<double>(i * i));
  }
}

/// Ranks as threads of one process.
class MailRanks : public Ranks {
 public:
  struct Office {
    explicit Office(int size) : boxes(static_cast<std::size_t>(size)) {}
    std::mutex mutex;
    std::vector<std::deque<Message>> boxes;
  };
  MailRanks(Office& office, int rank) : office_(office), rank_(rank) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(office_.boxes.size()); }
  void send(int to, const std::string& bytes) override {
    const std::lock_guard lock(office_.mutex);
    office_.boxes[static_cast<std::size_t>(to)].push_back({rank_, bytes});
  }
  [[nodiscard]] std::optional<Message> receive() override {
    const std::lock_guard lock(office_.mutex);
    auto& mine = office_.boxes[static_cast<std::size_t>(rank_)];
    if (mine.empty()) return std::nullopt;
    Message first = mine.front();
    mine.pop_front();
    return first;
  }
  void give_up() override {}

 private:
  Office& office_;
  int rank_;
};

std::vector<RunResult> run_on_ranks(int size, const std::vector<SweepRun>& runs, const SweepFolder& folder) {
  MailRanks::Office office(size);
  std::vector<std::thread> helpers;
  for (int rank = 1; rank < size; ++rank)
    helpers.emplace_back([&office, &runs, rank] {
      MailRanks mine(office, rank);
      help_sweep(runs, mine);
    });
  const RunStore store(folder.path(), "program");
  MailRanks first(office, 0);
  std::vector<RunResult> results = run_sweep(runs, store, first);
  for (std::thread& helper : helpers) helper.join();
  return results;
}

TEST(Sweep, RunsEverythingAndKeepsOneFilePerRun) {
  const SweepFolder folder;
  const Count worked = counter();
  expect_squares(run_alone(squares(30, worked), folder), 30);
  EXPECT_EQ(worked->load(), 30);
  EXPECT_EQ(folder.runs().size(), 30U);
}

TEST(Sweep, AFailingRunIsToldAndStopsNoOther) {
  const SweepFolder folder;
  SweepProgress last;
  SweepControl control;
  control.progress = [&last](const SweepProgress& progress) { last = progress; };
  const std::vector<RunResult> results = run_alone(squares(20, counter()), folder, control);
  EXPECT_EQ(results[13].error, "13 brings bad luck");
  EXPECT_FALSE(results[13].interrupted);
  EXPECT_EQ(last.done, 19U);
  EXPECT_EQ(last.failed, 1U);
  EXPECT_EQ(last.remaining, 0U);
}

TEST(Sweep, GoesOnWhereItWasAndTriesAgainWhatFailed) {
  const SweepFolder folder;
  const Count first = counter(), second = counter();
  (void)run_alone(squares(20, first), folder);
  const auto before = folder.runs();
  expect_squares(run_alone(squares(30, second), folder), 30);
  EXPECT_EQ(second->load(), 11);  // 10 new ones and the one that failed
  const auto after = folder.runs();
  for (const auto& [name, content] : before) EXPECT_EQ(after.at(name), content);
}

TEST(Sweep, DoesEqualRunsOnce) {
  const SweepFolder folder;
  const Count worked = counter();
  std::vector<SweepRun> runs = squares(10, worked);
  for (int number = 0; number < 10; ++number) {
    runs.push_back(square(number, worked));
    runs.back().name = "under another name";
  }
  const std::vector<RunResult> results = run_alone(runs, folder);
  EXPECT_EQ(worked->load(), 10);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(results[i + 10].outcome->number("square"), static_cast<double>(i * i));
}

TEST(Sweep, AnInterruptedSweepKeepsWhatIsFinished) {
  const SweepFolder folder;
  const Count worked = counter();
  SweepControl control;
  control.interrupted = [worked] { return worked->load() >= 5; };
  const std::vector<RunResult> results = run_alone(squares(40, worked), folder, control);
  std::size_t finished = 0;
  for (const RunResult& result : results) {
    finished += result.outcome ? 1 : 0;
    EXPECT_TRUE(result.outcome || result.interrupted);
  }
  EXPECT_EQ(finished, folder.runs().size());
  EXPECT_LT(finished, 40U);
  expect_squares(run_alone(squares(40, counter()), folder), 40);
}

TEST(Sweep, ResultsAreTheSameForAnyNumberOfRanksAndThreads) {
  const SweepFolder alone;
  (void)run_alone(squares(24, counter()), alone);
  int cases = 0;
  for (const int ranks : {1, 2, 3, 5}) {
    for (const std::size_t threads : {1U, 2U, 4U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const SweepFolder folder;
      const Count worked = counter();
      expect_squares(run_on_ranks(ranks, squares(24, worked), folder), 24);
      EXPECT_EQ(worked->load(), 24) << ranks << " ranks";
      EXPECT_EQ(folder.runs(), alone.runs()) << ranks << " ranks";
      ++cases;
    }
  }
  EXPECT_EQ(cases, 12);
}

TEST(Sweep, RunsThatMeasureTimeHaveTheMachineAlone) {
  const SweepFolder folder;
  const Count worked = counter();
  const auto active = std::make_shared<std::atomic<int>>(0);
  std::vector<SweepRun> runs;
  for (int number = 0; number < 12; ++number) {
    runs.push_back(square(number + 20, worked));
    const bool alone = number % 3 == 0;
    if (alone) runs.back().place = SweepRun::Place::alone;
    runs.back().work = [active, alone, work = runs.back().work](const Interrupted& interrupted) {
      if (++*active > 1 && alone) throw Error("not alone");
      RunOutcome outcome = work(interrupted);
      outcome.numbers["order"] = outcome.times["work"][0];  // counts the runs done so far
      --*active;
      return outcome;
    };
  }
  const std::vector<RunResult> results = run_on_ranks(3, runs, folder);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ASSERT_TRUE(results[i].outcome) << results[i].error;
    const double least = i % 3 == 0 ? 0.0085 : 0;  // after the eight others
    EXPECT_GT(results[i].outcome->number("order"), least);
  }
}

TEST(Sweep, AllRanksEndWhereNothingIsLeftToDo) {
  const SweepFolder folder;
  const Count worked = counter();
  (void)run_alone(squares(5, worked), folder);
  expect_squares(run_on_ranks(3, squares(5, worked), folder), 5);
  EXPECT_EQ(worked->load(), 5);
}

TEST(Sweep, RefusesRanksThatHaveOtherRuns) {
  const SweepFolder folder;
  MailRanks::Office office(2);
  MailRanks first(office, 0), second(office, 1);
  second.send(0, R"({"kind":"want","run":0,"text":"other","error":"","interrupted":false})");
  const RunStore store(folder.path(), "program");
  const std::vector<SweepRun> runs = squares(3, counter());
  try {
    (void)run_sweep(runs, store, first);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rank 1 has another list of runs"));
  }
}

}  // namespace
}  // namespace vantage
