#pragma once

#include "vantage/doctor/evidence.hpp"
#include "vantage/doctor/finding.hpp"

namespace vantage {

/// Whether the sensor tells "nothing is there" from "I do not know" where it meets nothing for most of its pixels.
/// Without that only surfaces behind the object clear the space around it, and coverage stalls.
[[nodiscard]] std::vector<Finding> check_no_return(const Evidence& evidence);

}  // namespace vantage
