#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/session/session_test_util.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;

std::vector<SessionScan> some_scans() {
  return {plate_from({0, 0, 2}), plate_from({1.5, 0.5, 1}), plate_from({-1, 1.5, 0.8}), plate_from({0.3, -2, 0.4})};
}

/// The map of a session of these scans.
VoxelMap map_of(const std::filesystem::path& folder, const std::vector<SessionScan>& scans,
                const ScanPlanningOptions& options) {
  Session::create(folder, options);
  Session session(folder);
  for (const SessionScan& scan : scans) (void)session.add(scan);
  return session.next().state->map;
}

TEST(SessionChanges, AScanThatWasTakenOutNeverCame) {
  const TestFolder folder;
  const ScanPlanningOptions options = small_options();
  const std::vector<SessionScan> scans = some_scans();
  const VoxelMap whole = map_of(folder / "whole", scans, options);
  const VoxelMap without = map_of(folder / "without", {scans[0], scans[2], scans[3]}, options);
  ASSERT_FALSE(same_map(whole, without));
  Session::create(folder / "s", options);
  {
    Session session(folder / "s");
    for (const SessionScan& scan : scans) (void)session.add(scan);
    session.remove(1);
    EXPECT_THAT(session.next().state->numbers, ElementsAre(0, 2, 3));
    EXPECT_THAT(session.status().removed, ElementsAre(1));
    EXPECT_EQ(session.status().stored, 3U);
    EXPECT_TRUE(same_map(session.next().state->map, without));
  }
  Session again(folder / "s");
  EXPECT_TRUE(again.status().dropped.empty()) << "it is not missing";
  EXPECT_THAT(again.status().removed, ElementsAre(1));
  EXPECT_TRUE(same_map(again.next().state->map, without)) << "after a restart";
  again.restore(1);
  EXPECT_THAT(again.next().state->numbers, ElementsAre(0, 1, 2, 3));
  EXPECT_TRUE(same_map(again.next().state->map, whole));
}

TEST(SessionChanges, RefusesNumbersThatAreNotThere) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  Session session(folder / "s");
  (void)session.add(some_scans()[0]);
  EXPECT_THROW(session.remove(1), InputError);
  EXPECT_THROW(session.remove(-1), InputError);
  EXPECT_THROW(session.restore(0), InputError);
  session.remove(0);
  EXPECT_THROW(session.remove(0), InputError);
  EXPECT_FALSE(session.next().plan.has_value()) << "nothing is left";
  EXPECT_EQ(session.add(some_scans()[1]).scan, 0) << "the first of the model again";
  EXPECT_THAT(session.next().state->numbers, ElementsAre(1)) << "with a number of its own";
}

TEST(SessionChanges, TakesOutWhatWaitsToBeMerged) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  Session session(folder / "s");
  (void)session.add(some_scans()[0]);
  EXPECT_EQ(session.store(some_scans()[1]), 1);
  session.remove(1);
  EXPECT_THROW((void)session.integrate(1), InputError);
  EXPECT_THAT(session.next().state->numbers, ElementsAre(0));
  session.restore(1);
  EXPECT_THAT(session.next().state->numbers, ElementsAre(0, 1));
}

TEST(SessionChanges, AFollowerHearsOfTheScansThatAreLeftAnew) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  std::vector<std::size_t> heard;
  Session session(folder / "s", [&](const SessionModel& model) { heard.push_back(model.numbers().size()); });
  for (const SessionScan& scan : some_scans()) (void)session.add(scan);
  session.remove(0);
  EXPECT_THAT(heard, ElementsAre(1, 2, 3, 4, 1, 2, 3));
}

TEST(SessionChanges, TellsWhetherAScanIsThereAlready) {
  const TestFolder folder;
  Session::create(folder / "s", small_options());
  std::vector<SessionScan> scans = some_scans();
  scans[3].key = "d";
  {
    Session session(folder / "s");
    for (const SessionScan& scan : scans) (void)session.add(scan);
  }
  Session session(folder / "s");
  scans[2].name = "another name";
  scans[2].candidate = 3;
  EXPECT_EQ(session.same_scan(scans[2]), 2);
  EXPECT_EQ(session.same_scan(scans[3]), 3);
  scans[3].key = "e";
  EXPECT_EQ(session.same_scan(scans[3]), std::nullopt) << "keys tell them apart";
  scans[2].believed.world_from_sensor.translation().x() += 1e-9;
  EXPECT_EQ(session.same_scan(scans[2]), std::nullopt) << "from elsewhere it is another scan";
  session.remove(1);
  EXPECT_EQ(session.same_scan(scans[1]), std::nullopt) << "what was taken out may come again";
}

}  // namespace
}  // namespace vantage
