#pragma once

#include <vector>

#include "vantage/experiments/estimate.hpp"

namespace vantage {

/// The mean of `ours` over the mean of `theirs`, paired run by run: the interval is that of the mean difference, in
/// units of the mean of `theirs`. Throws InputError where the lengths differ or that mean is 0.
[[nodiscard]] Estimate ratio_of_means(const std::vector<double>& ours, const std::vector<double>& theirs);

}  // namespace vantage
