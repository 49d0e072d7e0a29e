#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "readers.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<Reader> readers() {
  std::vector<Reader> all = file_readers();
  all.insert(all.end(), option_readers().begin(), option_readers().end());
  all.insert(all.end(), bag_readers().begin(), bag_readers().end());
  return all;
}

// Inputs that the fuzzer found or started from; each was once new to a reader.
TEST(FuzzCorpus, EveryInputIsReadOrRefused) {
  const fs::path corpus = VANTAGE_FUZZ_CORPUS;
  std::set<fs::path> known;
  for (const Reader& reader : readers()) {
    const fs::path folder = corpus / reader.group / reader.name;
    known.insert(folder);
    int accepted = 0, refused = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
      try {
        reader.read(read_file(entry.path()));
        ++accepted;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()), "");
        ++refused;
      }
    }
    EXPECT_GT(accepted, 0) << reader.name << ": the corpus has a valid file";
    EXPECT_GT(refused, 0) << reader.name << ": the corpus has a file that is not valid";
  }
  for (const auto& group : fs::directory_iterator(corpus)) {
    for (const auto& folder : fs::directory_iterator(group)) {
      if (folder.path().filename() == "found") continue;  // by fuzzing, for all readers of the group
      EXPECT_TRUE(known.count(folder.path())) << folder.path() << " belongs to no reader";
    }
  }
}

// The fuzzers of a group give every input to all of its readers.
TEST(FuzzCorpus, EveryInputIsReadOrRefusedByTheReadersOfLikeFormatsToo) {
  int reads = 0;
  for (const Reader& reader : readers()) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(VANTAGE_FUZZ_CORPUS) / reader.group)) {
      if (!entry.is_regular_file()) continue;
      try {
        reader.read(read_file(entry.path()));
      } catch (const InputError&) {
        // As it may be; anything else fails the test.
      }
      ++reads;
    }
  }
  EXPECT_GT(reads, 300);
}

}  // namespace
}  // namespace vantage::fuzz
