#include "vantage/experiments/compare_measures.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {

CompareMeasures measure_run(const RunOutcome& outcome, int budget, const std::string& covered, const RobotTime& time) {
  const std::vector<double>& coverage = outcome.list(covered);
  CompareMeasures result;
  std::size_t last = coverage.size();  // scans up to the last goal
  for (std::size_t g = 0; g < CompareMeasures::goals.size(); ++g) {
    const auto reached = std::find_if(coverage.begin(), coverage.end(),
                                      [goal = CompareMeasures::goals[g]](double c) { return c >= goal; });
    const bool is_reached = reached != coverage.end();
    result.views[g] = is_reached ? static_cast<double>(reached - coverage.begin()) + 1 : budget;
    if (g + 1 < CompareMeasures::goals.size()) continue;
    result.missed = is_reached ? 0 : 1;
    if (is_reached) last = static_cast<std::size_t>(reached - coverage.begin()) + 1;
  }
  result.distance = outcome.list("distance")[last - 1];
  result.seconds = time.scan * result.views.back() + result.distance / time.speed;
  for (std::size_t scan = 1; scan <= CompareMeasures::curve_length; ++scan) {
    result.area_under_curve += 100 * after_scan(outcome, covered, scan) / CompareMeasures::curve_length;
  }
  const std::vector<double>& overlap = outcome.list("overlap");
  double sum = 0;
  int counted = 0;
  for (std::size_t i = 1; i < last; ++i) {
    if (!std::isfinite(overlap[i])) continue;  // a scan that was not merged
    result.min_overlap = std::min(result.min_overlap, overlap[i]);
    sum += overlap[i];
    ++counted;
  }
  result.mean_overlap = counted > 0 ? sum / counted : 1;
  result.accuracy = outcome.number("accuracy");
  return result;
}

CompareMeasures over_objects(const std::vector<CompareMeasures>& objects) {
  CompareMeasures sum;
  const auto count = static_cast<double>(objects.size());
  for (const CompareMeasures& each : objects) {
    for (std::size_t g = 0; g < sum.views.size(); ++g) sum.views[g] += each.views[g];
    sum.distance += each.distance;
    sum.seconds += each.seconds;
    sum.missed += each.missed;
    sum.area_under_curve += each.area_under_curve / count;
    sum.min_overlap = std::min(sum.min_overlap, each.min_overlap);
    sum.mean_overlap += each.mean_overlap / count;
    sum.accuracy += each.accuracy / count;
  }
  return sum;
}

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<double> ranks;
  for (const double value : values) {
    const auto less = std::count_if(values.begin(), values.end(), [value](double v) { return v < value; });
    const auto equal = std::count(values.begin(), values.end(), value);
    ranks.push_back(static_cast<double>(less) + (static_cast<double>(equal) + 1) / 2);
  }
  return ranks;
}

}  // namespace vantage
