#pragma once

#include "vantage/doctor/evidence.hpp"
#include "vantage/doctor/finding.hpp"

namespace vantage {

/// Frames without a point, and sets of fewer than two frames, of which nothing can be compared.
[[nodiscard]] std::vector<Finding> check_frames(const Evidence& evidence);

}  // namespace vantage
