#pragma once

#include <memory>

#include "vantage/experiments/ranks.hpp"

namespace vantage::app {

/// All processes of MPI_COMM_WORLD. Initialises MPI, and finalises it when destroyed.
[[nodiscard]] std::unique_ptr<Ranks> make_mpi_ranks();

}  // namespace vantage::app
