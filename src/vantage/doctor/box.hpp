#pragma once

#include "vantage/doctor/agreement.hpp"
#include "vantage/doctor/finding.hpp"

namespace vantage {

/// Whether the frames, read as they are best explained, have points in the box that is given (cx cy cz sx sy sz,
/// metres).
[[nodiscard]] std::vector<Finding> check_box(const Evidence& evidence, const Reading& reading,
                                             const Eigen::Matrix<double, 6, 1>& box);

}  // namespace vantage
