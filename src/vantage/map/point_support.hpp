#pragma once

#include <cstdint>
#include <vector>

#include "vantage/map/voxel_map.hpp"

namespace vantage {

/// Adds the points of one scan to the map, each voxel's support by no more than VoxelEvidence::per_scan. Needs the
/// points in the order of the scan.
class PointSupport {
 public:
  explicit PointSupport(VoxelMap& map) : map_(map) {
    if (map.rule() != MapRule::evidence) return;
    once_.words.assign(map.layout().words(), 0);
    twice_.words.assign(map.layout().words(), 0);
  }

  /// The surface that the point at a voxel of the enclosure (scene index) belongs to, none where the voxel is not
  /// occupied; and whether it became so.
  VoxelMap::Supported add(const Index3& index, bool has_normal) {
    if (map_.rule() == MapRule::paper) {
      const auto [surface, is_new] = map_.occupy(index);
      return {&surface, is_new};
    }
    const Index3 local = index - map_.enclosure().min;
    const std::size_t word = map_.layout().word(local);
    const std::uint64_t bit = BitLayout::bit(local);
    const bool once = (once_.words[word] & bit) != 0;
    const bool twice = (twice_.words[word] & bit) != 0;
    once_.words[word] |= bit;
    if (once || has_normal) twice_.words[word] |= bit;
    const int counted = twice ? VoxelEvidence::per_scan : once ? 1 : 0;
    const int counts = once || has_normal ? VoxelEvidence::per_scan : 1;
    const VoxelMap::Supported supported = map_.support(index, std::max(0, counts - counted));
    if (supported.surface == nullptr) not_occupied_.push_back(index);
    return supported;
  }

  /// To be called after the scan was carved: what points fell into is not unmarked.
  void finish() {
    for (const Index3& index : not_occupied_) map_.hide_if_unmarked(index);
  }

 private:
  VoxelMap& map_;
  BitPlane once_, twice_;  // voxels that one, and that enough of this scan's points fell into
  std::vector<Index3> not_occupied_;
};

}  // namespace vantage
