#include "vantage/experiments/free_flyer.hpp"

#include <algorithm>

#include "vantage/experiments/estimate.hpp"

namespace vantage {

ReconstructOptions free_flyer() {
  ReconstructOptions options;
  options.camera = "92.5x72.32:320x240";
  options.candidates = "cube:17:4.1:0.82:1.9";
  options.navigation = false;
  options.max_views = 30;
  return options;
}

double mean_coverage(const RunOutcome& outcome) {
  double sum = 0;
  for (std::size_t scan = first_compared_scan; scan <= last_compared_scan; ++scan)
    sum += 100 * after_scan(outcome, "coverage", scan);
  return sum / (last_compared_scan - first_compared_scan + 1);
}

double views_to(double coverage, const RunOutcome& outcome) {
  const std::vector<double>& curve = outcome.list("coverage");
  const auto reached = std::find_if(curve.begin(), curve.end(), [coverage](double c) { return c >= coverage; });
  return static_cast<double>(reached - curve.begin()) + 1;
}

LineSeries curve_over_scans(const std::string& name, const std::vector<RunOutcome>& outcomes, const std::string& list,
                            double unit, std::size_t scans) {
  LineSeries series;
  series.name = name;
  for (std::size_t scan = 1; scan <= scans; ++scan) {
    const Estimate value =
        estimate(each(outcomes, [&](const RunOutcome& o) { return after_scan(o, list, scan) / unit; }));
    series.x.push_back(static_cast<double>(scan));
    series.y.push_back(value.mean);
    series.low.push_back(value.low);
    series.high.push_back(value.high);
  }
  return series;
}

}  // namespace vantage
