#include "vantage/server/live_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::StartsWith;

Json empty_run() {
  return {{"meta", {{"object", "mug"}, {"state", "running"}}}, {"scans", Json::array()}, {"next", nullptr}};
}

Json document_of(const LiveRun& run) { return Json::parse(*run.document()); }

TEST(LiveRun, HasNoDocumentAndNoGreetingBeforeItBegins) {
  LiveRun run;
  LiveRun::Reader reader;
  EXPECT_EQ(run.document(), nullptr);
  EXPECT_EQ(*run.next(reader, 1ms), "");
  EXPECT_THAT(run.greeting(reader), StartsWith(":"));
  EXPECT_THROW(run.add("scan", Json::object()), Error);
}

TEST(LiveRun, EventsChangeTheDocumentAsThePageDoes) {
  LiveRun run;
  run.begin(empty_run());
  run.add("plan", {{"chosen", 7}});
  EXPECT_EQ(document_of(run)["next"]["chosen"], 7);
  EXPECT_EQ(document_of(run)["revision"], 1);
  run.add("scan", {{"scan", 0}});
  run.add("state", {{"state", "finished"}, {"stop_reason", "done"}, {"message", "not kept"}});
  run.add("result", {{"mesh", {{"total", 3}}}});
  const Json document = document_of(run);
  EXPECT_EQ(document["scans"], Json::array({{{"scan", 0}}}));
  EXPECT_TRUE(document["next"].is_null());
  EXPECT_EQ(document["meta"]["state"], "finished");
  EXPECT_EQ(document["meta"]["object"], "mug");
  EXPECT_EQ(document["stop_reason"], "done");
  EXPECT_EQ(document["mesh"]["total"], 3);
  EXPECT_FALSE(document.contains("message"));
  EXPECT_EQ(document["revision"], 4);
}

TEST(LiveRun, ForgetsWhichViewIsTakenOnceItsScanIsThere) {
  LiveRun run;
  run.begin({{"scans", Json::array()}, {"next", nullptr}, {"camera", 1}, {"candidates", 2}});
  run.add("take", {{"candidate", 5}});
  EXPECT_EQ(document_of(run)["take"]["candidate"], 5);
  run.add("setup", {{"candidates", 3}});
  EXPECT_EQ(document_of(run)["candidates"], 3);
  EXPECT_EQ(document_of(run)["camera"], 1);
  run.add("scan", {{"scan", 0}});
  EXPECT_FALSE(document_of(run).contains("take"));
}

TEST(LiveRun, RefusesWhatIsNoEvent) {
  LiveRun run;
  run.begin(empty_run());
  EXPECT_THROW(run.add("scann", Json::object()), Error);
  EXPECT_THROW(run.add("scan", 3), InputError);
  EXPECT_EQ(document_of(run)["revision"], 0);
}

TEST(LiveRun, GreetsThenTellsEveryEventOnceInOrder) {
  LiveRun run;
  run.begin(empty_run());
  run.add("scan", {{"scan", 0}});
  LiveRun::Reader reader;
  EXPECT_THAT(*run.next(reader, 1ms), StartsWith("event: hello\ndata: {\"run\":"));
  EXPECT_EQ(*run.next(reader, 1ms), "");  // the scan is in the document
  run.add("scan", {{"scan", 1}});
  run.add("plan", {{"chosen", 2}});
  EXPECT_EQ(*run.next(reader, 1ms), "id: 2\nevent: scan\ndata: {\"scan\":1}\n\n");
  EXPECT_THAT(run.greeting(reader), HasSubstr("\"revision\":2"));
  EXPECT_EQ(*run.next(reader, 1ms), "id: 3\nevent: plan\ndata: {\"chosen\":2}\n\n");
  EXPECT_EQ(*run.next(reader, 1ms), "");
}

TEST(LiveRun, GreetsAnewForAnotherRun) {
  LiveRun run;
  run.begin(empty_run());
  LiveRun::Reader reader;
  const std::string first = *run.next(reader, 1ms);
  run.add("scan", {{"scan", 0}});
  run.begin(empty_run());
  const std::string second = *run.next(reader, 1ms);
  EXPECT_THAT(second, StartsWith("event: hello"));
  EXPECT_NE(first, second);
  EXPECT_EQ(document_of(run)["scans"].size(), 0U);
}

TEST(LiveRun, AReaderThatSleptFindsAGapInsteadOfHoldingEverythingUp) {
  LiveRun run;
  run.begin(empty_run());
  LiveRun::Reader sleeper;
  (void)run.next(sleeper, 1ms);
  for (int i = 0; i < 1000; ++i) run.add("state", {{"message", i}});
  const std::string text = *run.next(sleeper, 1ms);
  EXPECT_EQ(text, concat("id: 745\nevent: state\ndata: {\"message\":744}\n\n"));
  int events = 1;
  while (!run.next(sleeper, 1ms)->empty()) ++events;
  EXPECT_EQ(events, 256);
}

TEST(LiveRun, ManyReadersHearEverythingWhileItIsWritten) {
  LiveRun run;
  run.begin(empty_run());
  constexpr int readers = 4, events = 200;
  std::vector<int> heard(readers, 0);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < readers; ++i) {
      LiveRun::Reader reader;
      (void)run.next(reader, 1ms);
      threads.emplace_back([&run, reader, &count = heard[static_cast<std::size_t>(i)]]() mutable {
        while (const auto text = run.next(reader, 5s)) {
          if (text->empty()) break;
          if (reader.revision == static_cast<std::uint64_t>(++count) && count == events) break;
        }
      });
    }
    for (int i = 0; i < events; ++i) run.add("scan", {{"scan", i}});
  }
  EXPECT_THAT(heard, testing::Each(events));
  EXPECT_EQ(document_of(run)["scans"].size(), static_cast<std::size_t>(events));
}

TEST(LiveRun, CloseWakesAWaitingReader) {
  LiveRun run;
  run.begin(empty_run());
  LiveRun::Reader reader;
  (void)run.next(reader, 1ms);
  std::jthread closer([&run] {
    std::this_thread::sleep_for(20ms);
    run.close();
  });
  EXPECT_EQ(run.next(reader, 60s), nullptr);
}

TEST(LiveRun, ShowsNoFolderOfTheMachine) {
  LiveRun run;
  run.begin({{"meta", {{"options", {{"voxel", "0.02"}, {"robot", "/srv/cell/arm.yaml"}, {"seed", 1}}}}}});
  EXPECT_EQ(Json::parse(*run.document())["meta"]["options"],
            Json({{"voxel", "0.02"}, {"robot", "arm.yaml"}, {"seed", 1}}));
  run.begin({{"meta", 1}});
  run.begin({{"meta", {{"options", "none"}}}});
}

}  // namespace
}  // namespace vantage
