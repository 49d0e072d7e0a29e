#include "program_ranks.hpp"

#include <cstdlib>
#include <string>

#include "vantage/core/error.hpp"

#ifdef VANTAGE_MPI
#include "mpi_ranks.hpp"
#endif

namespace vantage::app {
namespace {

/// The number of processes that mpirun says it has started, 0 without mpirun.
int processes_started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* text = std::getenv(name)) return std::atoi(text);
  return 0;
}

}  // namespace

std::unique_ptr<Ranks> program_ranks() {
  if (processes_started() == 0) return std::make_unique<SingleRank>();
#ifdef VANTAGE_MPI
  return make_mpi_ranks();
#else
  if (processes_started() == 1) return std::make_unique<SingleRank>();
  throw Error("started by mpirun but built without MPI: run `cmake/install-packages mpi` and configure again");
#endif
}

}  // namespace vantage::app
