#pragma once

#include <chrono>

#include "vantage/search/search.hpp"

namespace vantage {

/// Until when to search, and what makes a view worth having.
struct TimeBox {
  std::chrono::steady_clock::time_point deadline;
  int stop_occplane = 0;  // a view is of use where it meets more occplane voxels than this
};

/// exhaustive_search that ends at a deadline: the feasible views that were evaluated by then, ranked; good ones come
/// early (ViewQueue). Each is evaluated whole, so that a thread may be late by one view. Where none of them is of use
/// it goes on until one is, or until all are evaluated: only then nothing is left to see. Which views there was time
/// for depends on the clock. A utility that compares views is asked once, in the last three quarters of the time, about
/// those that were looked at in the first.
[[nodiscard]] std::vector<Evaluation> search_until(const TimeBox& box, const ViewEvaluation& problem,
                                                   std::span<const int> feasible, const RayChoice& rays);

}  // namespace vantage
