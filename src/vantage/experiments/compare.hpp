#pragma once

#include "vantage/experiments/experiments.hpp"

namespace vantage {

/// Utilities and reference planners on the same objects from the same starts: what they need for 90 to 99 % of the
/// visible surface, with intervals of the differences from a baseline, paired by start; and how long the plans took.
[[nodiscard]] Experiment comparison(const ExperimentOptions& options);

}  // namespace vantage
