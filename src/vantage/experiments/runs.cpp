#include "vantage/experiments/runs.hpp"

#include <algorithm>
#include <mutex>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {

std::vector<RunOutcome> run_all(std::span<const ExperimentRun> runs, const RunProgress& progress) {
  std::vector<RunOutcome> outcomes(runs.size());
  std::mutex reporting;
  std::size_t done = 0;
  parallel_for(runs.size(), [&](std::size_t i) {
    const SimulatedRun run = simulate(*runs[i].object, runs[i].options);
    const ScanRecord& last = run.model.scans.back();
    RunOutcome& outcome = outcomes[i];
    outcome.views = static_cast<double>(run.model.scans.size());
    outcome.occupied = static_cast<double>(last.labels.occupied);
    outcome.quality = last.mean_quality;
    outcome.distance = last.distance;
    outcome.coverage = last.coverage.value_or(0);
    for (const ScanRecord& record : run.model.scans) outcome.coverage_by_scan.push_back(record.coverage.value_or(0));
    const std::lock_guard lock(reporting);
    progress(++done, runs.size());
  });
  return outcomes;
}

std::vector<double> values(std::span<const RunOutcome> outcomes, double RunOutcome::*member) {
  std::vector<double> result;
  for (const RunOutcome& outcome : outcomes) result.push_back(outcome.*member);
  return result;
}

double coverage_after(const RunOutcome& outcome, std::size_t scan) {
  require(scan >= 1 && !outcome.coverage_by_scan.empty(), "coverage after scan ", scan, ": scans count from 1");
  return outcome.coverage_by_scan[std::min(scan, outcome.coverage_by_scan.size()) - 1];
}

}  // namespace vantage
