#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/test_folder.hpp"
#include "vantage/experiments/sweep.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {

/// A fresh folder for the stored runs of one test.
class SweepFolder : public TestFolder {
 public:
  /// Name and content of every file in runs/.
  [[nodiscard]] std::map<std::string, std::string> runs() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(path() / "runs"))
      files[entry.path().filename().string()] = read_file(entry.path());
    return files;
  }
};

/// Counts how often a run has been worked on.
using Count = std::shared_ptr<std::atomic<int>>;

/// A run whose outcome is its number's square; number 13 fails.
inline SweepRun square(int number, const Count& worked) {
  return {fmt::format("square of {}", number), fmt::format(R"({{"kind":"square","number":{}}})", number),
          [number, worked](const Interrupted&) {
            ++*worked;
            if (number == 13) throw Error("13 brings bad luck");
            RunOutcome outcome;
            outcome.numbers["square"] = number * number;
            outcome.times["work"] = {0.001 * static_cast<double>(worked->load())};
            return outcome;
          }};
}

inline std::vector<SweepRun> squares(int count, const Count& worked) {
  std::vector<SweepRun> runs;
  for (int number = 0; number < count; ++number) runs.push_back(square(number, worked));
  return runs;
}

}  // namespace vantage
