#pragma once

#include <tbb/global_control.h>
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace vantage::app {

/// Options that say how a command runs, not what it computes.
struct ProgramOptions {
  int threads = 0;       // 0: as many as there are processors
  bool json = false;     // the result as JSON on standard output
  bool quiet = false;    // no progress
  bool verbose = false;  // a line for every infeasible view
};

void add_program_options(CLI::App& command, ProgramOptions& options);

/// Keeps oneTBB to the wanted number of threads as long as it lives; nothing for 0. Throws InputError for a negative
/// number.
[[nodiscard]] std::unique_ptr<tbb::global_control> limit_threads(int threads);

}  // namespace vantage::app
