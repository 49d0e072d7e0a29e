#include "vantage/runs/output_folder.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

OutputNames names(const std::string& command) {
  return {.command = command, .files = {"summary.json", "scans/scans.yaml"}, .patterns = {"scans/scan-*.pose.txt"}};
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// A session's folder, with what `finish` of an earlier version left where it did.
void make_session(const std::filesystem::path& folder) { write(folder / "session" / "options.yaml", "x"); }

TEST(OutputFolder, RemovesWhatTheRunBeforeWroteAndNothingElse) {
  const TestFolder folder;
  { const OutputFolder first(folder / "r", names("reconstruct")); }
  for (const char* name :
       {"summary.json", "notes.txt", "summary.json.old", "scans/scans.yaml", "scans/scan-001.pose.txt",
        "scans/scan-.pose.txt", "scans/scan-a1.pose.txt", "scans/scan-12.pose.txt", "scans/mine.txt",
        ".summary.json.12-0.tmp", "scans/.scan-002.pose.txt.12-0.tmp", "scans/.mine.txt.12-0.tmp"})
    write(folder / "r" / name, "x");
  { const OutputFolder second(folder / "r", names("plan")); }
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "r"))
    if (entry.is_regular_file()) left.push_back(entry.path().filename().string());
  std::sort(left.begin(), left.end());
  EXPECT_THAT(left, ElementsAre(".lock", ".mine.txt.12-0.tmp", ".vantage-run", "mine.txt", "notes.txt",
                                "scan-.pose.txt", "scan-a1.pose.txt", "summary.json.old"));
}

TEST(OutputFolder, DoesNotTouchAFolderOfOthersUnlessAskedTo) {
  const TestFolder folder;
  write(folder / "p" / "summary.json", "precious");
  EXPECT_THAT(input_error_of([&] { const OutputFolder run(folder / "p", names("plan")); }),
              HasSubstr("p: is not empty, and no run made it (there is summary.json)"));
  EXPECT_EQ(read_file(folder / "p" / "summary.json"), "precious");
  EXPECT_FALSE(std::filesystem::exists(folder / "p" / ".lock"));
  write(folder / "p" / "other", "stays");
  { const OutputFolder run(folder / "p", names("plan"), ForeignFiles::overwrite); }
  EXPECT_FALSE(std::filesystem::exists(folder / "p" / "summary.json"));
  EXPECT_EQ(read_file(folder / "p" / "other"), "stays");
  { const OutputFolder run(folder / "p", names("plan")); }  // it is the run's own by now
}

TEST(OutputFolder, TakesFoldersThatAreEmptyOrWereBarelyBegun) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "empty");
  { const OutputFolder run(folder / "empty", names("plan")); }
  write(folder / "begun" / ".lock", "");
  write(folder / "begun" / "..vantage-run.12-0.tmp", "");
  { const OutputFolder run(folder / "begun", names("plan")); }
  EXPECT_FALSE(std::filesystem::exists(folder / "begun" / "..vantage-run.12-0.tmp"));
}

TEST(OutputFolder, KnowsRunsOfEarlierVersionsByTheirFiles) {
  const TestFolder folder;
  for (const char* name : {"summary.json", "views.csv"}) write(folder / "r" / name, "x");
  write(folder / "r" / "config.yaml", "# vantage reconstruct mug --config THIS_FILE\n");
  { const OutputFolder run(folder / "r", names("reconstruct")); }
  EXPECT_FALSE(std::filesystem::exists(folder / "r" / "summary.json"));
  for (const char* name : {"runs/a.json", "times/a.json"}) write(folder / "e" / name, "x");
  { const OutputFolder run(folder / "e", names("experiment")); }
  EXPECT_THAT(input_error_of([&] { const OutputFolder run(folder / "e", names("plan")); }),
              HasSubstr("no run made it"));
  EXPECT_THAT(input_error_of([&] { const OutputFolder sweep(folder / "r", names("experiment")); }),
              HasSubstr("no experiment made it"));
  // What `vantage config` prints is nobody's run.
  write(folder / "c" / "config.yaml", "# vantage reconstruct\n");
  EXPECT_THAT(input_error_of([&] { const OutputFolder run(folder / "c", names("plan")); }), HasSubstr("config.yaml"));
}

TEST(OutputFolder, LeavesRunsOfNewerProgramsAsTheyAre) {
  const TestFolder folder;
  for (const char* name : {"summary.json", "views.csv"}) write(folder / "r" / name, "x");
  write(folder / "r" / "config.yaml", "# vantage reconstruct mug --config THIS_FILE\n");
  write(folder / "r" / ".vantage-run", "# vantage run, format 2\ncommand: reconstruct\n");
  for (const char* command : {"reconstruct", "experiment", "session"})
    EXPECT_THAT(input_error_of([&] { const OutputFolder run(folder / "r", names(command)); }),
                HasSubstr(".vantage-run: has format 2; this program knows 1"));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "r")) files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(files, 4U);
  EXPECT_EQ(read_file(folder / "r" / "summary.json"), "x");
}

TEST(OutputFolder, IsOfOneRunAtATime) {
  const TestFolder folder;
  const OutputFolder run(folder / "r", names("plan"));
  EXPECT_THAT(error_of([&] { const OutputFolder second(folder / "r", names("reconstruct")); }),
              HasSubstr("is writing there; wait for it or choose another --out"));
  EXPECT_THAT(error_of([&] { const OutputFolder second(folder / "r", names("reconstruct"), ForeignFiles::overwrite); }),
              HasSubstr("is writing there"));
}

TEST(OutputFolder, ASessionReplacesItsOwnFilesOnly) {
  const TestFolder folder;
  make_session(folder / "s");
  write(folder / "s" / "summary.json", "precious");
  EXPECT_THAT(input_error_of([&] { const OutputFolder run(folder / "s", names("session")); }),
              HasSubstr("summary.json: would be overwritten, and the session did not write it"));
  { const OutputFolder run(folder / "s", names("session"), ForeignFiles::overwrite); }
  write(folder / "s" / "summary.json", "its own");
  { const OutputFolder run(folder / "s", names("session")); }
  EXPECT_FALSE(std::filesystem::exists(folder / "s" / "summary.json"));
  EXPECT_THAT(input_error_of([&] { const OutputFolder run(folder / "s", names("plan")); }),
              HasSubstr("s: is the folder of a session"));
  make_session(folder / "with others");
  write(folder / "with others" / "frames" / "a.png", "x");
  { const OutputFolder run(folder / "with others", names("session")); }
}

TEST(NameOfFolder, IsTheLastNameAlsoOfPathsWithoutOne) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "tray");
  EXPECT_EQ(name_of_folder(folder / "tray"), "tray");
  EXPECT_EQ(name_of_folder(folder / "tray" / ""), "tray");
  EXPECT_EQ(name_of_folder(folder / "tray" / "."), "tray");
  EXPECT_EQ(name_of_folder(folder / "tray" / "a" / ".."), "tray");
  EXPECT_EQ(name_of_folder("."), std::filesystem::current_path().filename().string());
}

}  // namespace
}  // namespace vantage
