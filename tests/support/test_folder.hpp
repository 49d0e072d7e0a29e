#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {

/// A fresh folder that is removed again with everything in it.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "vantage-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw Error("cannot create " + name);
    path_ = name;
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Everything that lies in the folder, hidden files too, sorted.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  std::filesystem::path path_;
};

/// The text of the Error that the call throws; fails the test where it throws none or an InputError.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    ADD_FAILURE() << "InputError instead of a run-time error: " << error.what();
    return error.what();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

/// The text of the InputError that the call throws; fails the test where it throws none.
template <class Call>
std::string input_error_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return {};
}

struct FuzzCount {
  int accepted = 0, refused = 0;
};

/// Reads `rounds` damaged copies of a valid input: cut off, bytes replaced, deleted or inserted, digits changed. Each
/// must either be read or be refused with an InputError that has a text; anything else fails the test.
template <class Read>
FuzzCount read_damaged(const std::string& valid, int rounds, Read&& read) {
  Random random(20140724);
  FuzzCount count;
  for (int round = 0; round < rounds; ++round) {
    std::string bytes = valid;
    const int edits = 1 + random.index(4);
    for (int edit = 0; edit < edits && !bytes.empty(); ++edit) {
      // Half of the edits fall into the first bytes, where headers are.
      const auto length = static_cast<int>(bytes.size());
      const auto at = static_cast<std::size_t>(random.index(random.index(2) == 0 ? std::min(length, 300) : length));
      switch (random.index(6)) {
        case 0:
          bytes.resize(at);
          break;
        case 1:
          bytes[at] = static_cast<char>(random.bits());
          break;
        case 2:
          bytes.erase(at, 1 + static_cast<std::size_t>(random.index(8)));
          break;
        case 3:
          bytes.insert(at, 1, static_cast<char>(random.bits()));
          break;
        case 4:
          bytes[at] = static_cast<char>('0' + random.index(10));
          break;
        default:
          constexpr std::array<const char*, 7> nasty{"-1", "99999999999999999999", "nan", "1e400", "inf", " ", "\n"};
          bytes.insert(at, nasty[static_cast<std::size_t>(random.index(static_cast<int>(nasty.size())))]);
      }
    }
    try {
      read(bytes);
      ++count.accepted;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()), "");
      ++count.refused;
    }
  }
  return count;
}

}  // namespace vantage
