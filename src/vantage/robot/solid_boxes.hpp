#pragma once

#include <vector>

#include "vantage/map/voxel_map.hpp"

namespace vantage {

/// Boxes that do not overlap and together fill what is not known to be empty, each made of as many voxels as go into it
/// when it grows along x, then y, then z: thousands of voxels make a few hundred boxes. World frame, metres.
[[nodiscard]] std::vector<Box3> solid_boxes(const VoxelMap& map);

}  // namespace vantage
