#include "vantage/server/folder_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "vantage/core/error.hpp"
#include "vantage/report/report.hpp"
#include "vantage/runs/run_log.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

class FolderWatchTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("watch-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "scans");
  }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  void write_report(const Json& document) {
    write(
        "report.html",
        fill_page(R"(<!--vantage-static--><script type="application/json" id="vantage-data"></script>)", document, ""));
  }

  static Json document(const std::string& object) {
    return {{"format", "vantage-run"},
            {"meta", {{"object", object}, {"state", "running"}}},
            {"scans", Json::array()},
            {"next", nullptr}};
  }
  [[nodiscard]] Json shown() const { return run_.document() ? Json::parse(*run_.document()) : Json(nullptr); }

  std::filesystem::path folder_;
  LiveRun run_;
};

TEST_F(FolderWatchTest, ShowsTheReportOfAFinishedRun) {
  write_report(document("mug </script>"));
  FolderWatch watch(folder_, run_);
  watch.look();
  EXPECT_EQ(shown()["meta"]["object"], "mug </script>");
  run_.add("state", {{"state", "waiting"}});
  watch.look();
  EXPECT_EQ(shown()["revision"], 1) << "the same report is not read again";
}

TEST_F(FolderWatchTest, FollowsARunFromItsFirstScanToItsReport) {
  FolderWatch watch(folder_, run_);
  watch.look();
  EXPECT_TRUE(shown().is_null());
  RunLog log(folder_);
  log.add("run", document("pear"));
  log.add("scan", {{"scan", 0}});
  watch.look();
  EXPECT_EQ(shown()["scans"].size(), 1U);
  log.add("plan", {{"chosen", 4}});
  watch.look();
  EXPECT_EQ(shown()["next"]["chosen"], 4);
  EXPECT_EQ(shown()["meta"]["state"], "running");
  log.add("scan", {{"scan", 1}});
  log.add("state", {{"state", "finished"}, {"stop_reason", "done"}});
  watch.look();
  EXPECT_EQ(shown()["revision"], 4);
  write_report(document("pear"));
  log.remove();
  watch.look();
  EXPECT_EQ(shown()["scans"].size(), 2U) << "the report says no more than the log did";
}

TEST_F(FolderWatchTest, DoesNotReadHalfALine) {
  write("live.jsonl", R"({"event":"run","data":)" + document("mug").dump() + "}\n" + R"({"event":"scan","da)");
  FolderWatch watch(folder_, run_);
  watch.look();
  EXPECT_EQ(shown()["scans"].size(), 0U);
}

TEST_F(FolderWatchTest, SaysThatARunWasBrokenOff) {
  {
    RunLog log(folder_);
    log.add("run", document("mug"));
    log.add("scan", {{"scan", 0}});
  }
  FolderWatch watch(folder_, run_);
  watch.look();
  watch.look();
  EXPECT_EQ(shown()["meta"]["state"], "finished");
  EXPECT_EQ(shown()["stop_reason"], "the run was broken off");
  EXPECT_EQ(shown()["revision"], 2);
}

TEST_F(FolderWatchTest, ShowsTheNextRunInTheSameFolder) {
  write_report(document("mug"));
  FolderWatch watch(folder_, run_);
  watch.look();
  for (const char* object : {"pear", "banana"}) {
    RunLog log(folder_);
    log.add("run", document(object));
    watch.look();
    EXPECT_EQ(shown()["meta"]["object"], object);
    log.remove();
    write_report(document(object));
    watch.look();
  }
}

TEST_F(FolderWatchTest, OneFolderTakesOneRunAtATime) {
  const RunLog log(folder_);
  EXPECT_THROW(RunLog{folder_}, Error);
}

TEST_F(FolderWatchTest, CountsTheRunsOfAnExperimentUntilItsReportIsThere) {
  std::filesystem::remove(folder_ / "scans");
  std::filesystem::create_directories(folder_ / "runs");
  std::filesystem::create_directories(folder_ / "times");
  write("runs/a-1.json", "{}");
  FolderWatch watch(folder_, run_);
  watch.look();
  EXPECT_EQ(shown()["format"], "vantage-experiment");
  EXPECT_EQ(shown()["text"][0], "1 run is finished.");
  write("runs/b-2.json", "{}");
  write("runs/c-3.json.new", "{");
  watch.look();
  EXPECT_EQ(shown()["text"][0], "2 runs are finished.");
  write_report({{"format", "vantage-experiment"}, {"version", 1}, {"title", "table 1"}});
  watch.look();
  EXPECT_EQ(shown()["title"], "table 1");
  write("runs/d-4.json", "{}");
  watch.look();
  EXPECT_EQ(shown()["title"], "table 1");
}

TEST_F(FolderWatchTest, SaysWhatIsWrongWithAFolder) {
  EXPECT_THROW(FolderWatch(folder_ / "none", run_), InputError);
  std::filesystem::remove(folder_ / "scans");
  EXPECT_THROW(FolderWatch(folder_, run_), InputError);
  for (const char* report :
       {"no data", R"(<script type="application/json" id="vantage-data"></script>)",
        R"(<script type="application/json" id="vantage-data">{</script>)",
        R"(<script type="application/json" id="vantage-data">{"format")",
        R"(<script type="application/json" id="vantage-data">{"format":"other"}</script>)",
        R"(<script type="application/json" id="vantage-data">{"format":"vantage-run","version":2}</script>)"}) {
    write("report.html", report);
    FolderWatch watch(folder_, run_);
    EXPECT_THROW(watch.look(), InputError) << report;
  }
  for (const char* log : {"{\n", "[]\n", "{\"event\":3,\"data\":{}}\n", "{\"event\":\"run\",\"data\":[]}\n"}) {
    write("live.jsonl", log);
    FolderWatch watch(folder_, run_);
    EXPECT_THROW(watch.look(), InputError) << log;
  }
}

}  // namespace
}  // namespace vantage
