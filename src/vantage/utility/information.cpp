#include "vantage/utility/information.hpp"

#include "vantage/core/error.hpp"

namespace vantage {

void OccupancyProbabilities::validate() const {
  for (const double p : {unknown, empty, occupied}) {
    require(p > 0 && p < 1, "occupancy probability = ", p, ": must be in (0, 1)");
  }
}

}  // namespace vantage
