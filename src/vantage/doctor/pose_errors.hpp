#pragma once

#include "vantage/doctor/agreement.hpp"
#include "vantage/doctor/finding.hpp"

namespace vantage {

/// Whether some frames stand so far from where they belong that registration, which searches `pose_error` metres around
/// the believed pose, will not put them right.
[[nodiscard]] std::vector<Finding> check_pose_errors(const Evidence& evidence, const Reading& reading,
                                                     double pose_error);

}  // namespace vantage
