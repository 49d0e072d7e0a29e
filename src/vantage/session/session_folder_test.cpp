#include "vantage/session/session_folder.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/session/sealed_file.hpp"
#include "vantage/session/session.hpp"
#include "vantage/session/session_test_util.hpp"

namespace vantage {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class SessionFolderTest : public testing::Test {
 protected:
  void SetUp() override { SessionFolder::create(session_, small_options()); }

  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return session_ / "session" / name; }
  /// Stores scans from different places, all registered where they are believed.
  void add_scans(int count) {
    Session session(session_);
    for (int i = 0; i < count; ++i) (void)session.add(plate_from({0.1 * i, 0.2, 2}));
  }

  TestFolder folder_;
  std::filesystem::path session_ = folder_ / "s";
};

TEST_F(SessionFolderTest, NoticesEveryChangeOfItsOptions) {
  const std::string whole = read_file(file("options.yaml"));
  EXPECT_THAT(whole, HasSubstr("\n# crc32 "));
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 37) {
    std::string changed = whole;
    changed[at] = changed[at] == '1' ? '2' : '1';
    write_file_atomically(file("options.yaml"), changed);
    EXPECT_THAT(input_error_of([&] { (void)SessionFolder::options_of(session_); }), HasSubstr("options.yaml"));
    write_file_atomically(file("options.yaml"), whole.substr(0, at));
    EXPECT_THAT(input_error_of([&] { (void)SessionFolder::options_of(session_); }), HasSubstr("options.yaml"));
    ++refused;
  }
  EXPECT_GT(refused, 20);
  write_file_atomically(file("options.yaml"), whole);
  EXPECT_EQ(SessionFolder::options_of(session_).scene.views, 20);
}

TEST_F(SessionFolderTest, OpensOptionsOfTheFirstFormatAndNamesNewerOnes) {
  write_file_atomically(file("options.yaml"),
                        "# vantage session, format 1\nbox: [0, 0, 0, 1, 1, 1]\nvoxel: 0.1\nviews: 80\n");
  EXPECT_EQ(SessionFolder::options_of(session_).scene.views, 80);
  const std::string newer = "# vantage session, format 3\nbox: here\n";
  write_file_atomically(file("options.yaml"), newer);
  write_file_atomically(file("000000.scan.1-0.tmp"), "of a newer program");
  write_file_atomically(file("000001.scan"), "of a newer program");
  std::filesystem::remove(file(".lock"));
  EXPECT_THAT(input_error_of([&] { const Session session(session_); }), HasSubstr("has format 3"));
  EXPECT_FALSE(std::filesystem::exists(file(".lock")));
  for (const char* name : {"000000.scan.1-0.tmp", "000001.scan"})
    EXPECT_EQ(read_file(file(name)), "of a newer program");
  EXPECT_EQ(read_file(file("options.yaml")), newer);
}

TEST_F(SessionFolderTest, IsMadeOnce) {
  const std::string options = read_file(file("options.yaml"));
  ScanPlanningOptions other = small_options();
  other.scene.views = 80;
  EXPECT_THAT(input_error_of([&] { SessionFolder::create(session_, other); }), HasSubstr("already is a session"));
  {
    std::filesystem::create_directories(folder_ / "t" / "session");
    const FolderLock other_maker(folder_ / "t" / "session", "");
    EXPECT_THAT(error_of([&] { SessionFolder::create(folder_ / "t", other); }), HasSubstr("another process"));
  }
  EXPECT_EQ(read_file(file("options.yaml")), options);
  add_scans(1);
  std::filesystem::remove(file("options.yaml"));
  EXPECT_THAT(input_error_of([&] { SessionFolder::create(session_, other); }),
              HasSubstr("holds the scans of a session whose options.yaml is gone"));
}

TEST_F(SessionFolderTest, RefusesOptionsThatNoViewCanBePlannedWith) {
  const auto refusal = [&](const auto& change) {
    ScanPlanningOptions options = small_options();
    change(options);
    return input_error_of([&] { SessionFolder::create(folder_ / "t", options); });
  };
  for (const int views : {81, -1, 0, 19})
    EXPECT_THAT(refusal([&](auto& o) { o.scene.views = views; }), HasSubstr("must be 20*4^k"));
  for (const double radius : {1e300, 1e-300, 0.0, -1.0})
    EXPECT_THAT(refusal([&](auto& o) { o.scene.radius = radius; }), HasSubstr("radius = "));
  EXPECT_THAT(refusal([&](auto& o) { o.scene.radius = 5e5; }), HasSubstr("distance = 500000"));
  EXPECT_THAT(refusal([&](auto& o) { o.planning.search = "exhaustiv"; }), HasSubstr("exhaustive, multi-resolution"));
  EXPECT_THAT(refusal([&](auto& o) {
                o.planning.utility = "gain";
                o.planning.search = "multi-resolution";
              }),
              HasSubstr("use it with the exhaustive search"));
  EXPECT_THAT(refusal([&](auto& o) { o.scene.voxel = 1e-4; }), HasSubstr("does not fit in memory"));
  EXPECT_FALSE(SessionFolder::is_session(folder_ / "t"));
}

TEST_F(SessionFolderTest, KeepsFilesOfItsOptionsSeenFromAnywhere) {
  const std::filesystem::path before = std::filesystem::current_path();
  write_file_atomically(folder_ / "K.txt", "");
  std::filesystem::create_directories(folder_ / "poses");
  std::filesystem::current_path(folder_.path());
  ScanPlanningOptions options = small_options();
  options.reading.intrinsics = "K.txt";
  options.reading.poses = "poses";
  options.reading.masks = "in the scans' folder";
  SessionFolder::create(folder_ / "t", options);
  std::filesystem::current_path(before);
  const ScanFolderOptions reading = SessionFolder::options_of(folder_ / "t").reading;
  EXPECT_TRUE(std::filesystem::equivalent(reading.intrinsics, folder_ / "K.txt"));
  EXPECT_TRUE(std::filesystem::equivalent(reading.poses, folder_ / "poses"));
  EXPECT_EQ(reading.masks, "in the scans' folder");
}

TEST_F(SessionFolderTest, NeverTakesThePoseOfAnotherScan) {
  add_scans(2);
  EXPECT_TRUE(SessionFolder(session_).located(1));
  std::filesystem::copy_file(file("000000.scan"), file("000001.scan"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_TRUE(SessionFolder(session_).located(0));
  EXPECT_FALSE(SessionFolder(session_).located(1)) << "what was found belongs to the scan that was there";
  // The last scan is gone: what was found for it is not taken for the next one.
  std::filesystem::remove(file("000001.scan"));
  SessionFolder folder(session_);
  EXPECT_EQ(folder.store(plate_from({1, 0, 1})), 2);
  EXPECT_FALSE(folder.located(2));
}

TEST_F(SessionFolderTest, MissesScansWhoseFilesAreGone) {
  add_scans(5);
  for (const char* name : {"000001.scan", "000003.scan", "000003.located", "000004.scan"})
    std::filesystem::remove(file(name));
  Session session(session_);
  EXPECT_THAT(session.status().dropped, ElementsAre(HasSubstr("scan 1 is missing"), HasSubstr("scan 3 is missing"),
                                                    HasSubstr("scan 4 is missing")));
  EXPECT_EQ(session.status().integrated, 2U);
}

TEST_F(SessionFolderTest, IsNotKeptBusyByAFileWithAHugeNumber) {
  add_scans(1);
  std::filesystem::copy_file(file("000000.scan"), file("999999999.scan"));
  std::filesystem::copy_file(file("000000.scan"), file("2147483647.scan"));  // no number of a scan
  Session session(session_);
  EXPECT_EQ(session.status().integrated, 2U);
  EXPECT_EQ(session.status().dropped.size(), 11U);
  EXPECT_THAT(error_of([&] { (void)session.store(plate_from({1, 0, 1})); }), HasSubstr("has no number left"));
  EXPECT_EQ(session.status().dropped.back(), "999999988 more scans are missing: their files are gone");
}

TEST_F(SessionFolderTest, LeavesFilesOfNewerProgramsAsTheyAre) {
  add_scans(2);
  const std::string newer = sealed("vantage-scan-2 something else");
  write_file_atomically(file("000001.scan"), newer);
  Session session(session_);
  EXPECT_THAT(session.status().left_out, ElementsAre(Pair(1, HasSubstr("newer version"))));
  EXPECT_EQ(read_file(file("000001.scan")), newer);
  EXPECT_EQ(session.status().integrated, 1U);
  EXPECT_EQ(session.store(plate_from({1, 0, 1})), 2);
}

TEST_F(SessionFolderTest, OpensAllTheSameWhereOneFileCannotBeLookedAt) {
  add_scans(3);
  for (const char* name : {"000001.scan", "000000.located", "skipped.json", "000007.scan"}) {
    std::filesystem::remove(file(name));
    std::filesystem::create_symlink(name, file(name));  // a link to itself
  }
  Session session(session_);
  EXPECT_EQ(session.status().integrated, 2U);
  EXPECT_THAT(session.status().left_out, ElementsAre(Pair(1, HasSubstr("000001.scan")), Pair(7, HasSubstr("000007"))));
  EXPECT_THAT(session.status().dropped, Contains(HasSubstr("forgot which views were skipped")));
  std::filesystem::remove(file("options.yaml"));
  std::filesystem::create_symlink("options.yaml", file("options.yaml"));
  EXPECT_FALSE(SessionFolder::is_session(session_));
}

TEST_F(SessionFolderTest, SaysWhereADamagedScanCannotBePutAside) {
  add_scans(1);
  write_file_atomically(file("000000.scan"), "damaged");
  std::filesystem::create_directories(file("000000.damaged") / "taken");
  Session session(session_);
  EXPECT_THAT(session.status().dropped,
              ElementsAre(testing::AllOf(HasSubstr("left out scan 0"), HasSubstr("it cannot be renamed to"))));
  EXPECT_EQ(read_file(file("000000.scan")), "damaged");
}

TEST_F(SessionFolderTest, TakesAScanOnceThatIsThereTwiceWithItsKey) {
  SessionScan scan = plate_from({0, 0.2, 2});
  scan.key = "a";
  (void)Session(session_).add(scan);
  std::filesystem::copy_file(file("000000.scan"), file("000001.scan"));
  Session session(session_);
  EXPECT_EQ(session.status().integrated, 1U);
  EXPECT_THAT(session.status().dropped, ElementsAre(HasSubstr("left out scan 1: it has the key of scan 0")));
  EXPECT_EQ(session.store(scan), 0);
  EXPECT_EQ(session.store(plate_from({1, 0, 1})), 2);
}

TEST_F(SessionFolderTest, RefusesKeysThatItWouldNotKnowAgain) {
  SessionScan scan = plate_from({0, 0.2, 2});
  scan.key = "Gr\xf6\xdf\x65";
  Session session(session_);
  EXPECT_THAT(input_error_of([&] { (void)session.store(scan); }), HasSubstr("its key: is not UTF-8"));
  scan.key = "Gr\xc3\xb6\xc3\x9f\x65";
  EXPECT_EQ(session.store(scan), 0);
  EXPECT_THAT(session.status().left_out, IsEmpty());
}

TEST_F(SessionFolderTest, PlansFromWhereMergedScansWereTaken) {
  ScanPlanningOptions options = small_options();
  options.scene.registration = "icp";
  SessionFolder::create(folder_ / "t", options);
  Session session(folder_ / "t");
  (void)session.add(plate_from({0, 0, 2}));
  EXPECT_DOUBLE_EQ(session.status().state->radius, 2);
  SessionScan elsewhere = plate_from({0, 0, 2.2});  // its pose came in millimetres
  elsewhere.believed.world_from_sensor.translation() *= 1000;
  EXPECT_FALSE(session.add(elsewhere).merged);
  EXPECT_DOUBLE_EQ(session.status().state->radius, 2);
  EXPECT_TRUE(session.next().plan);
}

TEST_F(SessionFolderTest, ARunOfWrongPosesThatWereBelievedHardlyMovesTheViews) {
  Session session(session_);  // takes every pose for granted
  for (const double height : {2.0, 2.1, 900.0, 2.2, 2.3}) (void)session.add(plate_from({0, 0, height}));
  EXPECT_DOUBLE_EQ(session.status().state->radius, 2.2);
}

}  // namespace
}  // namespace vantage
