#include "vantage/session/session.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
#include <new>
#include <thread>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/session/sealed_file.hpp"
#include "vantage/session/session_test_util.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<SessionScan> some_scans() {
  return {plate_from({0, 0, 2}), plate_from({1.5, 0.5, 1}), plate_from({-1, 1.5, 0.8}), plate_from({0.3, -2, 0.4})};
}

TEST(Session, GoesOnAfterARestartWithTheSameMapAndPlan) {
  const TestFolder folder;
  Session::create(folder / "at once", small_options());
  Session::create(folder / "restarted", small_options());
  Session at_once(folder / "at once");
  int plans = 0;
  for (const SessionScan& scan : some_scans()) {
    (void)at_once.add(scan);
    (void)Session(folder / "restarted").add(scan);
    Session restarted(folder / "restarted");
    const SessionPlan plan = at_once.next(), again = restarted.next();
    EXPECT_EQ(plan.state->scans.size(), again.state->scans.size());
    EXPECT_GT(plan.state->map.count(Label::occupied), 0);
    EXPECT_TRUE(same_map(plan.state->map, again.state->map));
    EXPECT_EQ(plan.why_finished, again.why_finished);
    ASSERT_EQ(plan.plan.has_value(), again.plan.has_value());
    if (!plan.plan) continue;
    EXPECT_EQ(plan.plan->best.candidate, again.plan->best.candidate);
    EXPECT_EQ(plan.plan->best.utility, again.plan->best.utility);
    ++plans;
  }
  EXPECT_EQ(at_once.status().merged, 4U);
  EXPECT_GT(plans, 0);
}

TEST(Session, MergesWhatWasStoredButNotYetMergedBeforeItEnded) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  {
    Session session(folder / "s");
    (void)session.add(some_scans()[0]);
    EXPECT_EQ(session.store(some_scans()[1]), 1);
    EXPECT_EQ(session.status().stored, 2U);
    EXPECT_EQ(session.status().integrated, 1U);
  }
  Session session(folder / "s");
  EXPECT_EQ(session.status().integrated, 2U);
  EXPECT_THAT(session.next().state->numbers, ElementsAre(0, 1));
}

TEST(Session, StoresAScanWithAKeyOnceAlsoAfterARestart) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  std::vector<SessionScan> scans = some_scans();
  scans[0].key = "a";
  scans[1].key = "b";
  {
    Session session(folder / "s");
    EXPECT_EQ(session.store(scans[0]), 0);
    EXPECT_EQ(session.store(scans[0]), 0) << "not merged yet";
    EXPECT_EQ(session.add(scans[1]).scan, 1);
    EXPECT_EQ(session.add(scans[0]).scan, 0) << "merged";
    EXPECT_EQ(session.status().stored, 2U);
  }
  Session session(folder / "s");
  EXPECT_EQ(session.add(scans[1]).scan, 1);
  EXPECT_EQ(session.store(scans[2]), 2);
  EXPECT_EQ(session.store(scans[2]), 3) << "without a key every scan is another one";
  EXPECT_EQ(session.status().stored, 4U);
}

TEST(Session, LeavesOutADamagedScanAndSaysSo) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  for (const SessionScan& scan : some_scans()) (void)Session(folder / "s").add(scan);
  // Cut off in every way that a disk may: nothing, half, all but the last byte.
  const std::filesystem::path file = folder / "s" / "session" / "000002.scan";
  const std::string whole = read_file(file);
  int cases = 0;
  for (const std::size_t size : {std::size_t{0}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(file, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(size));
    Session session(folder / "s");
    EXPECT_EQ(session.status().integrated, 3U);
    EXPECT_THAT(session.status().dropped, ElementsAre(HasSubstr("left out scan 2")));
    EXPECT_EQ(session.store(some_scans()[0]), 4 + cases) << "a number is given out once";
    std::filesystem::remove(folder / "s" / "session" / ("00000" + std::to_string(4 + cases) + ".scan"));
    std::filesystem::remove(folder / "s" / "session" / "000002.damaged");
    std::ofstream(folder / "s" / "session" / ("00000" + std::to_string(4 + cases) + ".damaged"));
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

TEST(Session, WhoeverFollowsItChangesNothing) {
  const TestFolder folder;
  Session::create(folder / "followed", small_options());
  Session::create(folder / "alone", small_options());
  Session followed(folder / "followed", [](const SessionModel& model) {
    if (model.numbers().back() == 1) throw std::bad_alloc();
  });
  Session alone(folder / "alone");
  for (const SessionScan& scan : some_scans()) {
    EXPECT_TRUE(followed.add(scan).merged);
    (void)alone.add(scan);
  }
  const SessionStatus status = followed.status();
  EXPECT_EQ(status.integrated, 4U);
  EXPECT_THAT(status.left_out, testing::IsEmpty());
  EXPECT_THAT(status.warnings, ElementsAre(HasSubstr("scan 1 was merged, but whoever follows the session")));
  EXPECT_TRUE(same_map(status.state->map, alone.status().state->map));
}

TEST(Session, KeepsAScanThatCannotBeReadNowAndThen) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  for (const SessionScan& scan : some_scans()) (void)Session(folder / "s").add(scan);
  const std::filesystem::path file = folder / "s" / "session" / "000002.scan";
  std::filesystem::rename(file, folder / "away");
  std::filesystem::create_directory(file);  // reads like a failing disk: an error, not other bytes
  {
    Session session(folder / "s");
    EXPECT_THAT(session.status().left_out, ElementsAre(testing::Pair(2, HasSubstr("000002.scan"))));
    EXPECT_THAT(session.status().dropped, testing::IsEmpty());
    EXPECT_EQ(session.status().integrated, 3U);
    EXPECT_EQ(session.store(some_scans()[0]), 4) << "a later scan is stored";
    EXPECT_TRUE(session.integrate(4).merged);
  }
  std::filesystem::remove(file);
  std::filesystem::rename(folder / "away", file);
  EXPECT_EQ(Session(folder / "s").status().integrated, 5U);
}

TEST(Session, IsOpenOnce) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  const Session session(folder / "s");
  EXPECT_THAT(error_of([&] { const Session second(folder / "s"); }),
              HasSubstr("another process has this session open"));
}

TEST(Session, KeepsWhichViewsWereSkipped) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  int best = -1, second = -1;
  {
    Session session(folder / "s");
    (void)session.add(some_scans()[0]);
    const auto plan = session.next().plan;
    best = plan->ranking[0].candidate;
    second = plan->ranking[1].candidate;
    session.skip(best, "a cable is in the way");
    EXPECT_EQ(session.next().plan->best.candidate, second);
  }
  Session session(folder / "s");
  EXPECT_EQ(session.next().plan->best.candidate, second);
  session.unskip(best);
  EXPECT_EQ(session.next().plan->best.candidate, best);
  EXPECT_THAT(input_error_of([&] { session.unskip(best); }), HasSubstr("was not skipped"));
  EXPECT_THAT(input_error_of([&] { session.skip(20, "far"); }), HasSubstr("0 .. 19"));
}

TEST(Session, RemembersWhichViewsWereScannedForUtilitiesThatTakeNoneTwice) {
  const TestFolder folder;
  ScanPlanningOptions options = small_options();
  options.planning.utility = "random";
  Session::create(folder / "s", options);
  SessionScan scan = plate_from({0, 0, 2});
  scan.candidate = 4;
  (void)Session(folder / "s").add(scan);
  const SessionPlan next = Session(folder / "s").next();
  ASSERT_TRUE(next.plan) << next.why_finished;
  ASSERT_EQ(next.plan->infeasible.size(), 1U);
  EXPECT_EQ(next.plan->infeasible.front().candidate, 4);
  EXPECT_EQ(next.plan->infeasible.front().reason, "has been scanned from");
}

TEST(Session, AnswersManyThreadsAndKeepsEveryScan) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  std::atomic<int> answers = 0;
  {
    Session session(folder / "s");
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (const SessionScan& scan : some_scans()) {
          const ScanRecord record = session.add(scan);
          const SessionPlan plan = session.next();
          // Once all is seen there is no plan but the reason for that.
          const bool answered = plan.plan.has_value() || !plan.why_finished.empty();
          if (answered && record.merged && plan.state->scans.size() <= 16) ++answers;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(session.status().integrated, 16U);
  }
  EXPECT_EQ(answers, 16);
  EXPECT_EQ(Session(folder / "s").status().integrated, 16U);
}

TEST(SessionScan, IsTheSameAfterStoring) {
  PointScan lines;
  lines.points = {{0.1, 0.2, 0.30000000000000004}, {1, -0.0, 2}};
  lines.normals = {{0, 0, -1}, {0, 0, 0}};
  lines.origins = {{0.1, 0.18, 1.3}, {1, 0.18, 1.3}};
  lines.axis = -Vec3::UnitZ();
  SessionScan scan{"a \"name\"", view_towards({1, 2, 3}, {0.1, 0.2, 0.3}), lines, 17};
  scan.commanded = view_towards({1.1, 2, 3}, {0.1, 0.2, 0.3});
  const SessionScan read = parse_scan(scan_bytes(scan), "scan");
  const auto& points = std::get<PointScan>(read.scan);
  EXPECT_EQ(read.name, scan.name);
  EXPECT_EQ(read.candidate, 17);
  EXPECT_EQ(read.believed.world_from_sensor.matrix(), scan.believed.world_from_sensor.matrix());
  ASSERT_TRUE(read.commanded);
  EXPECT_EQ(read.commanded->world_from_sensor.matrix(), scan.commanded->world_from_sensor.matrix());
  EXPECT_EQ(points.points, lines.points);
  EXPECT_EQ(points.normals, lines.normals);
  EXPECT_EQ(points.origins, lines.origins);
  EXPECT_EQ(points.axis, lines.axis);

  const SessionScan plate = plate_from({1, 2, 3});
  const SessionScan plate_read = parse_scan(scan_bytes(plate), "scan");
  EXPECT_EQ(std::get<ImageScan>(plate_read.scan).image.depth, std::get<ImageScan>(plate.scan).image.depth);
  EXPECT_EQ(std::get<ImageScan>(plate_read.scan).image.camera.left, std::get<ImageScan>(plate.scan).image.camera.left);
}

TEST(SessionScan, KeysThatWereStoredOnceStayReadable) {
  SessionScan scan = plate_from({0, 0, 2});
  scan.key = "scan\t1";  // refused today
  EXPECT_EQ(parse_scan(scan_bytes(scan), "scan").key, scan.key);
}

TEST(SessionScan, DamagedBytesAreReadOrRefused) {
  const FuzzCount count = read_damaged(scan_bytes(plate_from({0, 0, 2})), 2000, [](const std::string& bytes) {
    try {
      (void)parse_scan(bytes, "scan");
    } catch (const NewerFormat& error) {
      throw InputError(error.what());
    }
  });
  EXPECT_GT(count.refused, 500);
  EXPECT_EQ(count.accepted + count.refused, 2000);
}

TEST(SealedFile, TellsEveryChangeOfAByte) {
  // The check value of CRC-32 (ISO-HDLC) for "123456789" is published: cbf43926.
  EXPECT_EQ(sealed("123456789"), "123456789\ncrc32 cbf43926\n");
  const std::string whole = sealed("123456789");
  EXPECT_EQ(unsealed(whole, "file"), "123456789");
  int cases = 0;
  for (std::size_t i = 0; i < whole.size(); ++i, ++cases) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 4);
    EXPECT_THAT(input_error_of([&] { (void)unsealed(changed, "file"); }), HasSubstr("file: is damaged"));
  }
  EXPECT_EQ(cases, 25);
  EXPECT_THAT(input_error_of([&] { (void)unsealed("short", "file"); }), HasSubstr("cut off"));
}

}  // namespace
}  // namespace vantage
