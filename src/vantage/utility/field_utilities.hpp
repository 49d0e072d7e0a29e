#pragma once

#include "vantage/utility/utility.hpp"

// Utilities that the field compares itself with and that need no rays, and plain references.
namespace vantage {

/// Massios and Fisher (1998): half the share of the best view's occplane voxels, half the mean lack of quality 1 - q of
/// the visible occupied voxels. Equal weights; q is the voxel's best cosine so far.
[[nodiscard]] Utility massios_fisher_utility();

/// Sanchiz and Fisher (1999), overlap plus unknown area: n_u + min(n_oc, n_u) with n_u = n_op + n_um. Overlap counts up
/// to as much as is unknown: more of it says nothing new.
[[nodiscard]] Utility sanchiz_fisher_utility();

/// Blaer and Allen (2007): visible boundary voxels, that is unknown ones with an empty 6-neighbour.
[[nodiscard]] Utility blaer_allen_utility();

/// Every view of the candidates as likely, drawn again with every seed; no view twice.
[[nodiscard]] Utility random_utility();

/// Always the view that is farthest, as an angle seen from the middle of the enclosure, from all scanned so far: a
/// fixed order that spreads evenly and does not look at the map.
[[nodiscard]] Utility uniform_utility();

}  // namespace vantage
