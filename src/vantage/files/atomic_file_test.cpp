#include "vantage/files/atomic_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(AtomicFile, WhatIsWrittenIsRead) {
  const TestFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  write_file_atomically(folder / "file", bytes);
  EXPECT_EQ(read_file(folder / "file"), bytes);
  write_file_atomically(folder / "file", "");
  EXPECT_EQ(read_file(folder / "file"), "");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(AtomicFile, StreamsMoreThanOneChunk) {
  const TestFolder folder;
  AtomicFile file(folder / "large");
  std::string expected;
  for (int i = 0; i < 300'000; ++i) {
    const std::string piece = std::to_string(i) + " ";
    file.write(piece);
    expected += piece;
  }
  file.commit();
  ASSERT_GT(expected.size(), std::size_t{1} << 20U);
  EXPECT_EQ(read_file(folder / "large"), expected);
}

TEST(AtomicFile, WithoutCommitTheOldFileStays) {
  const TestFolder folder;
  write_file_atomically(folder / "file", "old");
  {
    AtomicFile file(folder / "file");
    file.write("new");
    EXPECT_EQ(folder.names().size(), 2U) << "the new bytes lie beside the file";
  }
  EXPECT_EQ(read_file(folder / "file"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(AtomicFile, TwoWritersOfOneFileDoNotMix) {
  const TestFolder folder;
  AtomicFile first(folder / "file");
  AtomicFile second(folder / "file");
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(read_file(folder / "file"), "first");
}

TEST(AtomicFile, UnwritablePathsAreErrorsThatNameThem) {
  const TestFolder folder;
  write_file_atomically(folder / "file", "x");
  EXPECT_THAT(error_of([&] { write_file_atomically(folder / "no" / "file", "x"); }),
              HasSubstr("no/file: cannot be written: No such file or directory"));
  EXPECT_THAT(error_of([&] { write_file_atomically(folder / "file" / "below", "x"); }),
              HasSubstr("file/below: cannot be written: Not a directory"));
  std::filesystem::create_directories(folder / "taken" / "inner");
  EXPECT_THAT(error_of([&] { write_file_atomically(folder / "taken", "x"); }),
              HasSubstr("taken: cannot be written: Is a directory"));
  EXPECT_THAT(error_of([] { write_file_atomically("", "x"); }), HasSubstr("not the name of a file"));
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"file", "taken"}));
}

/// Lets no file grow beyond some size while it lives, as a full disk would.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_action_);
  }

 private:
  rlimit old_{};
  void (*old_action_)(int);
};

TEST(AtomicFile, ADiskThatTakesNoMoreIsAnErrorAndLeavesTheOldFile) {
  const TestFolder folder;
  write_file_atomically(folder / "file", "old");
  std::string message;
  {
    const FileSizeLimit limit(100'000);
    message = error_of([&] { write_file_atomically(folder / "file", std::string(300'000, 'x')); });
  }
  EXPECT_THAT(message, HasSubstr("file: writing failed: File too large"));
  EXPECT_EQ(read_file(folder / "file"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(AtomicFile, WhatAKilledProcessLeftIsRemovedAndNothingElse) {
  const TestFolder folder;
  for (const char* name : {".file.12-0.tmp", ".file.7-13.tmp", ".file.tmp", ".file..tmp", ".other.12-0.tmp",
                           ".file.12-0.tmp.kept", "file.12-0.tmp", ".file.my-0.tmp"})
    std::ofstream(folder / name) << "x";
  remove_unfinished(folder / "file");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{".file..tmp", ".file.12-0.tmp.kept", ".file.my-0.tmp",
                                                      ".file.tmp", ".other.12-0.tmp", "file.12-0.tmp"}));
  remove_unfinished(folder / "none" / "file");
}

TEST(CreateFolders, MakesWhatIsMissingAndSaysWhatIsInTheWay) {
  const TestFolder folder;
  create_folders(folder / "a" / "b" / "" / "c" / "");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a" / "b" / "c"));
  create_folders(folder / "a" / "b");
  std::filesystem::create_directory_symlink(folder / "a" / "b", folder / "link");
  create_folders(folder / "link" / "d");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a" / "b" / "d"));
  write_file_atomically(folder / "file", "x");
  EXPECT_THAT(error_of([&] { create_folders(folder / "file" / "below"); }),
              HasSubstr("cannot create the folder " + (folder / "file" / "below").string() + ": "));
}

TEST(ReadFile, UnreadablePathsAreInputErrors) {
  const TestFolder folder;
  EXPECT_THAT(input_error_of([&] { (void)read_file(folder / "none"); }),
              HasSubstr("none: cannot be read: No such file or directory"));
  EXPECT_THAT(input_error_of([&] { (void)read_file(folder.path()); }), HasSubstr("is a folder, must be a file"));
  EXPECT_THAT(input_error_of([] { (void)read_file("/dev/zero"); }), HasSubstr("/dev/zero: is not a regular file"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(input_error_of([&] { (void)read_file(folder / "pipe"); }), HasSubstr("pipe: is not a regular file"));
}

}  // namespace
}  // namespace vantage
