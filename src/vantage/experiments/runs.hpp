#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vantage/reconstruction/simulate.hpp"

namespace vantage {

/// One independent reconstruction of an experiment. The object must outlive the run.
struct ExperimentRun {
  const SimulatedObject* object = nullptr;
  ReconstructOptions options;
};

/// What statistics need of a finished run.
struct RunOutcome {
  double views = 0, occupied = 0, quality = 0, distance = 0, coverage = 0;
  std::vector<double> coverage_by_scan;
};

/// Called after each finished run with the number done so far; from any thread, one call at a time.
using RunProgress = std::function<void(std::size_t done, std::size_t all)>;

/// All runs on all threads; outcomes in the order of the runs, the same for any number of threads.
[[nodiscard]] std::vector<RunOutcome> run_all(std::span<const ExperimentRun> runs, const RunProgress& progress);

/// One member of each outcome.
[[nodiscard]] std::vector<double> values(std::span<const RunOutcome> outcomes, double RunOutcome::*member);

/// Coverage after scan `scan` (from 1); after the last scan its value is carried forward.
[[nodiscard]] double coverage_after(const RunOutcome& outcome, std::size_t scan);

}  // namespace vantage
