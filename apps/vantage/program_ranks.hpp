#pragma once

#include <memory>

#include "vantage/experiments/ranks.hpp"

namespace vantage::app {

/// The processes that this program was started with: those of `mpirun`, or this one alone. Throws Error where mpirun
/// started a program that was built without MPI, since every process would do all the work.
[[nodiscard]] std::unique_ptr<Ranks> program_ranks();

}  // namespace vantage::app
