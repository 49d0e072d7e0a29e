#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/visibility/exposed_voxels.hpp"
#include "vantage/visibility/splat_batch.hpp"

namespace vantage {

/// The voxels that rays which may pass occupied voxels can meet: non-empty ones with an empty or occupied neighbour on
/// a side that faces the camera, for the eight octants of a camera outside of the enclosure.
class PassableVoxels {
 public:
  /// The map must outlive this.
  PassableVoxels(const VoxelMap& map, SelectInside select);
  /// Appends the voxels of a region that rays can meet which pass only voxels of `passable`, a plane that holds the
  /// empty voxels and no others than occupied ones. Packed, in an order in which no voxel hides an earlier one.
  /// `batch` is of the region; `facing` is memory to work in.
  void collect(const BitPlane& passable, const Region& region, const BatchRegion& batch, BitPlane& facing,
               std::vector<std::uint32_t>& voxels) const;

 private:
  [[nodiscard]] static std::size_t number(const std::array<int, 3>& side) {
    return (side[0] > 0 ? 1U : 0U) + (side[1] > 0 ? 2U : 0U) + (side[2] > 0 ? 4U : 0U);
  }

  const VoxelMap* map_;
  SelectInside select_;
  std::array<std::vector<std::uint32_t>, 8> octants_;
};

}  // namespace vantage
