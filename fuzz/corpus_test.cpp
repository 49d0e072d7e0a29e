#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "readers.hpp"
#include "vantage/core/error.hpp"
#include "vantage/io/atomic_file.hpp"

namespace vantage::fuzz {
namespace {

// Inputs that the fuzzer found or started from; each was once new to a reader.
TEST(FuzzCorpus, EveryInputIsReadOrRefused) {
  std::set<std::string> known;
  for (const Reader& reader : readers()) {
    known.emplace(reader.name);
    int accepted = 0, refused = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(VANTAGE_FUZZ_CORPUS) / reader.name)) {
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
  for (const auto& entry : std::filesystem::directory_iterator(VANTAGE_FUZZ_CORPUS)) {
    EXPECT_TRUE(known.count(entry.path().filename().string())) << entry.path() << " belongs to no reader";
  }
}

}  // namespace
}  // namespace vantage::fuzz
