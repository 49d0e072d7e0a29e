#include "vantage/experiments/run_store.hpp"

#include <gtest/gtest.h>

#include "vantage/experiments/sweep_test_util.hpp"

namespace vantage {
namespace {

const Count nobody_counts = std::make_shared<std::atomic<int>>(0);

RunOutcome outcome_of(const SweepRun& run) {
  return run.work([] { return false; });
}

TEST(RunStore, GivesBackWhatWasSaved) {
  const SweepFolder folder;
  const SweepRun run = square(7, nobody_counts);
  {
    const RunStore store(folder.path(), "program 1");
    EXPECT_FALSE(store.load(run));
    store.save(run, outcome_of(run));
  }
  const auto loaded = RunStore(folder.path(), "program 1").load(run);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->number("square"), 49);
  EXPECT_EQ(loaded->time("work").size(), 1U);
}

TEST(RunStore, DoesNotTakeWhatAnotherProgramMade) {
  const SweepFolder folder;
  const SweepRun run = square(7, nobody_counts);
  RunStore(folder.path(), "program 1").save(run, outcome_of(run));
  EXPECT_FALSE(RunStore(folder.path(), "program 2").load(run));
}

TEST(RunStore, ComparesTheWholeConfigurationAndNotTheFileNameAlone) {
  const SweepFolder folder;
  const RunStore store(folder.path(), "program");
  const SweepRun seven = square(7, nobody_counts), eight = square(8, nobody_counts);
  store.save(seven, outcome_of(seven));
  // As if both had the same digest.
  std::filesystem::copy_file(store.file_of(seven), store.file_of(eight));
  for (const char* kind : {"runs", "times"})
    std::filesystem::copy_file(folder.path() / kind / store.file_of(seven).filename(),
                               folder.path() / kind / store.file_of(eight).filename(),
                               std::filesystem::copy_options::skip_existing);
  EXPECT_FALSE(store.load(eight));
  EXPECT_TRUE(store.load(seven));
}

TEST(RunStore, RepeatsRunsThatFailed) {
  const SweepFolder folder;
  const RunStore store(folder.path(), "program");
  const SweepRun run = square(13, nobody_counts);
  store.save_failure(run, "bad luck");
  EXPECT_NE(read_file(store.file_of(run)).find("bad luck"), std::string::npos);
  EXPECT_FALSE(store.load(run));
}

TEST(RunStore, RepeatsRunsWhoseFileIsDamaged) {
  const SweepFolder folder;
  const RunStore store(folder.path(), "program");
  const SweepRun run = square(5, nobody_counts);
  store.save(run, outcome_of(run));
  const std::string whole = read_file(store.file_of(run));
  int cases = 0;
  for (std::size_t length = 0; length < whole.size(); length += 7, ++cases) {
    write_file_atomically(store.file_of(run), whole.substr(0, length));
    EXPECT_FALSE(store.load(run)) << length;
  }
  EXPECT_GT(cases, 20);
  write_file_atomically(store.file_of(run), "[1, 2]");
  EXPECT_FALSE(store.load(run));
  store.save(run, outcome_of(run));
  EXPECT_TRUE(store.load(run));
}

TEST(RunStore, KeepsTwoSweepsOutOfOneFolder) {
  const SweepFolder folder;
  const RunStore first(folder.path(), "program");
  EXPECT_THROW(RunStore(folder.path(), "program"), Error);
}

TEST(RunStore, RemovesWhatAKilledSweepWasWriting) {
  const SweepFolder folder;
  { const RunStore store(folder.path(), "program"); }
  write_file_atomically(folder.path() / "runs" / "kept.json", "{}");
  write_file_atomically(folder.path() / "runs" / ".kept.json.123-0.tmp", "{");
  const RunStore store(folder.path(), "program");
  EXPECT_EQ(folder.runs().size(), 1U);
}

TEST(RunStore, SaysWhereItCannotWrite) {
  try {
    const RunStore store("/proc/nowhere", "program");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/nowhere"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vantage
