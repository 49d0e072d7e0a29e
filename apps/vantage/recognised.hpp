#pragma once

#include <fmt/core.h>

#include "vantage/recordings/scan_folder.hpp"

namespace vantage::app {

/// What a recording was recognised as, and what of it is left out, on standard error.
inline void print_recognised(const ScanSet& set) {
  if (!set.description.empty()) fmt::print(stderr, "{}\n", set.description);
  for (const std::string& line : set.left_out) fmt::print(stderr, "vantage: left out: {}\n", line);
}

}  // namespace vantage::app
