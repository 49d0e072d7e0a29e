#pragma once

#include "vantage/simulation/simulate.hpp"
#include "vantage/utility/utility.hpp"

// Planners that know the object: what is possible with the same candidates, start and sensor. They see which voxels a
// noise-free scan from every candidate puts points into, and how much of the visible surface lies in each.
namespace vantage {

/// The view whose scan covers most surface that the map does not hold yet. Never a view twice.
[[nodiscard]] Utility known_greedy_utility(const SimulatedObject& object, const ReconstructOptions& options);

/// The smallest set of views, the start among them, whose scans cover `goal` of the visible surface, as far as swaps
/// find it: beginning with the greedy set, one view less at a time as long as exchanging one or two views reaches the
/// goal. Scans them nearest first, then goes on greedily.
[[nodiscard]] Utility known_optimum_utility(const SimulatedObject& object, const ReconstructOptions& options,
                                            double goal = 0.99);

/// What scans from candidate views would cover: bit sets over the visible voxels, with their shares of the surface.
struct KnownScans {
  std::vector<Index3> voxels;                       // visible ones that hold surface, scene indices
  std::vector<double> area;                         // share of the visible surface in each
  std::vector<std::vector<std::uint64_t>> of_view;  // by candidate

  [[nodiscard]] double covered(const std::vector<std::uint64_t>& held) const;
};
[[nodiscard]] KnownScans known_scans(const SimulatedObject& object, const ReconstructOptions& options);
/// Candidates to scan from, `start` first; see known_optimum_utility.
[[nodiscard]] std::vector<int> smallest_cover(const KnownScans& scans, int start, double goal);

}  // namespace vantage
