#pragma once

#include <string>
#include <vector>

#include "vantage/model/from_scans.hpp"

namespace vantage {

/// Scans whose poses were found from the scans alone.
struct FoundScans {
  std::vector<PendingScan> scans;  // those that were found, in the order in which they were
  std::vector<std::string> notes;  // what became of each, a sentence
};

/// Finds the poses of scans of which nothing is believed (see find_poses()), in the frame of the first one where that
/// was found. All scans are read once. Throws InputError where no two scans fit together.
[[nodiscard]] FoundScans with_found_poses(const std::vector<PendingScan>& scans, const SensorOptions& sensor);

}  // namespace vantage
