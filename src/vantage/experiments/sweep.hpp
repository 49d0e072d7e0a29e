#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vantage/experiments/local_workers.hpp"
#include "vantage/experiments/ranks.hpp"
#include "vantage/experiments/run_store.hpp"

namespace vantage {

/// How far a sweep is.
struct SweepProgress {
  std::size_t stored = 0;     // outcomes of earlier starts
  std::size_t done = 0;       // finished now
  std::size_t failed = 0;     // now
  std::size_t remaining = 0;  // still to come, those going on included
  double seconds = 0;         // since the start
  double seconds_left = 0;    // estimated from the runs done; 0 before the first
};

struct SweepControl {
  Interrupted interrupted = [] { return false; };
  /// Called from the calling thread after every change and about once a second.
  std::function<void(const SweepProgress&)> progress = [](const SweepProgress&) {};
};

/// Rank 0 of a sweep: hands the runs out to the threads of all ranks and stores every outcome when it is there; runs
/// whose outcome is stored already are not repeated, and equal ones are done once. Returns the results in the order of
/// the runs; they do not depend on the number of ranks and threads. A run that fails does not stop the others.
[[nodiscard]] std::vector<RunResult> run_sweep(std::span<const SweepRun> runs, const RunStore& store, Ranks& ranks,
                                               const SweepControl& control = {});

/// Any other rank of the same sweep, called with the same runs: works on what rank 0 hands out until nothing is left.
void help_sweep(std::span<const SweepRun> runs, Ranks& ranks, const SweepControl& control = {});

}  // namespace vantage
