#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/visibility/exposed_voxels.hpp"

namespace vantage {

/// The voxels that rays which may pass occupied voxels can meet: non-empty ones with an empty or occupied neighbour on
/// a side that faces the camera, for the eight octants of a camera outside of the enclosure.
class PassableVoxels {
 public:
  explicit PassableVoxels(const VoxelMap& map);
  /// Packed, in an order in which no voxel hides an earlier one.
  [[nodiscard]] const std::vector<std::uint32_t>& octant(const std::array<int, 3>& side) const {
    return octants_[number(side)];
  }

 private:
  [[nodiscard]] static std::size_t number(const std::array<int, 3>& side) {
    return (side[0] > 0 ? 1U : 0U) + (side[1] > 0 ? 2U : 0U) + (side[2] > 0 ? 4U : 0U);
  }

  std::array<std::vector<std::uint32_t>, 8> octants_;
};

}  // namespace vantage
