#include "vantage/runs/run_log.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

std::filesystem::path log_in(const TestFolder& folder) { return folder / "live.jsonl"; }

TEST(RunLog, TakesThePlaceOfOneThatAKilledRunLeft) {
  const TestFolder folder;
  write_file_atomically(log_in(folder), "{\"event\":\"run\"}\n");
  RunLog log(folder.path());
  EXPECT_EQ(read_file(log_in(folder)), "");
  log.add("state", {{"state", "running"}});
  EXPECT_EQ(read_file(log_in(folder)), "{\"event\":\"state\",\"data\":{\"state\":\"running\"}}\n");
  log.remove();
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

TEST(RunLog, NeverTakesAwayTheLogOfAnotherRun) {
  const TestFolder folder;
  {
    RunLog log(folder.path());
    write_file_atomically(log_in(folder), "of another run\n");  // has replaced it meanwhile
    log.remove();
    EXPECT_EQ(read_file(log_in(folder)), "of another run\n");
  }
  EXPECT_EQ(read_file(log_in(folder)), "of another run\n") << "nothing was added to the first: it goes, not this one";
}

TEST(RunLog, WhoeverAsksWhetherItIsWrittenKeepsNoRunFromStarting) {
  const TestFolder folder;
  write_file_atomically(log_in(folder), "left behind\n");
  // A look at the log holds a shared lock on it for a moment; here for long.
  const int looks = ::open(log_in(folder).c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(looks, LOCK_SH), 0);
  {
    const RunLog log(folder.path());
    EXPECT_TRUE(RunLog::is_written(log_in(folder)));
    EXPECT_THROW(RunLog{folder.path()}, Error);
  }
  ::close(looks);
  EXPECT_FALSE(RunLog::is_written(log_in(folder)));
}

}  // namespace
}  // namespace vantage
