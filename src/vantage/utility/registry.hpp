#pragma once

#include <span>
#include <string>
#include <vector>

#include "vantage/utility/utility.hpp"

namespace vantage {

/// A utility that `--utility NAME` finds. docs/new-utility.md shows how to add one.
struct UtilityEntry {
  const char* name;
  const char* meaning;  // for help and documents
  Utility (*make)();
};

/// All of them, the paper's first.
[[nodiscard]] std::span<const UtilityEntry> known_utilities();
[[nodiscard]] std::vector<std::string> utility_names();
/// Throws InputError that lists the names.
[[nodiscard]] Utility utility_by_name(const std::string& name);

}  // namespace vantage
