#pragma once

#include <array>

#include "vantage/utility/utility.hpp"
#include "vantage/visibility/sight.hpp"

namespace vantage {

/// What the gain utility goes by. The defaults are what docs/methods.md reports on.
struct GainOptions {
  double rays_per_ideal = 2;  // rays per axis, as a multiple of the ideal resolution (eq. 14)
  GrazingPass grazing{0.45};  // rays may once pass a surface that is seen edge-on
  /// Worth of an unknown voxel by the 6-connected steps through unknown voxels to the nearest occupied one: up to 1, up
  /// to 3, up to 7, beyond.
  std::array<double, 4> worth{1, 0.513, 0.189, 0.036};
  double lookahead = 0.8;         // worth of what the best view after this one adds
  double travel = 0.05;           // price of the longest way
  double min_overlap = 0.15;      // least share of occupied voxels among those that are met
  double floor_step = 0.8;        // lowers the floor where no view reaches it
  double refusal_step = 2;        // raises it with every scan that could not be merged, up to
  double highest_floor = 0.6;     // this
  double last_view_share = 0.01;  // one view may leave this much: then the view after it does not matter

  /// Throws InputError naming the field.
  void validate() const;
};

/// Chooses by the worth W of the unknown voxels that a view and the best view after it would meet, as shares of what
/// all views together would: (W(S_v) + lookahead max_u W(S_u \ S_v)) / W(all S) + travel (1 - x), 0 for views that
/// overlap too little or meet nothing. Never chooses a view twice.
[[nodiscard]] Utility gain_utility(const GainOptions& options = {});

/// Unknown voxels in classes by their steps to the nearest occupied voxel, local bit planes: up to 1, 3, 7 steps.
[[nodiscard]] std::array<BitPlane, 3> unknown_near_occupied(const VoxelMap& map);

}  // namespace vantage
