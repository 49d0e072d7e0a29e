#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/search/search.hpp"

namespace vantage {
namespace {

/// n_i of eq. 16.
std::size_t views_kept(int b, int stage, int stages) {
  constexpr double more_than_any = 1e9;
  return static_cast<std::size_t>(std::llround(std::min(std::pow(b, stages - stage), more_than_any)));
}

}  // namespace

void MultiResolutionOptions::validate() const {
  require(b >= 2, "multi-resolution: b = ", b, ": must be at least 2");
  require(!stages || (*stages >= 1 && *stages <= 16), "multi-resolution: k = ", stages.value_or(0),
          " stages: must be in 1..16");
  require(min_columns >= 1, "multi-resolution: R_min = ", min_columns, " columns: must be positive");
}

int number_of_stages(int views, int b) {
  int stages = 1;
  for (std::int64_t reach = b; reach < views; reach *= b) ++stages;
  return stages;
}

Resolution stage_resolution(Resolution ideal, int min_columns, int stage, int stages) {
  if (stage >= stages) return ideal;
  const double least_columns = std::min(min_columns, ideal.columns);
  const double least_rows = least_columns * ideal.rows / ideal.columns;
  const double steps_left = static_cast<double>(stages - stage) / (stages - 1);
  const auto at_stage = [steps_left](double ideal_count, double least) {
    return std::max(1, static_cast<int>(std::lround(ideal_count - steps_left * (ideal_count - least))));
  };
  return {at_stage(ideal.columns, least_columns), at_stage(ideal.rows, least_rows)};
}

std::vector<Evaluation> multi_resolution_search(const ViewEvaluation& problem, std::span<const int> feasible,
                                                const MultiResolutionOptions& options) {
  const int k = options.stages.value_or(number_of_stages(static_cast<int>(problem.candidates.views.size()), options.b));
  std::vector<int> views(feasible.begin(), feasible.end());  // V
  std::vector<Evaluation> evaluations;
  for (int i = 1; i <= k; ++i) {
    std::vector<Resolution> resolutions;  // R_i, eq. 15
    resolutions.reserve(views.size());
    for (const int candidate : views) {
      resolutions.push_back(stage_resolution(problem.ideal(candidate), options.min_columns, i, k));
    }
    evaluations = problem.evaluate(views, resolutions);
    rank(evaluations);
    if (i == k) break;
    evaluations.resize(std::min(evaluations.size(), views_kept(options.b, i, k)));  // n_i, eq. 16
    views.clear();
    for (const Evaluation& evaluation : evaluations) views.push_back(evaluation.candidate);
  }
  return evaluations;
}

}  // namespace vantage
