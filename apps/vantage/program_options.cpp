#include "program_options.hpp"

#include "vantage/core/error.hpp"

namespace vantage::app {

void add_program_options(CLI::App& command, ProgramOptions& options) {
  command.add_option("--threads", options.threads, "number of threads; 0: as many as processors")
      ->capture_default_str();
  command.add_flag("--json", options.json, "print the result as JSON on standard output");
  command.add_flag("--quiet", options.quiet, "print no progress");
  command.add_flag("--verbose", options.verbose, "list every infeasible view, not their numbers by reason");
}

std::unique_ptr<tbb::global_control> limit_threads(int threads) {
  require(threads >= 0 && threads <= 4096, "threads = ", threads, ": must be in 0..4096");
  if (threads == 0) return nullptr;
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               static_cast<std::size_t>(threads));
}

}  // namespace vantage::app
