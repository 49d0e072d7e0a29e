#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/visibility/splat_batch.hpp"

namespace vantage {

/// The normals of a map's occupied voxels, one after the other in the order of the bits: the number of a voxel is the
/// number of occupied ones before it.
class SurfaceNormals {
 public:
  explicit SurfaceNormals(const VoxelMap& map);

  /// The voxel must be occupied; local index.
  [[nodiscard]] const Vec3& operator[](const Index3& local) const {
    const std::size_t word = layout_.word(local);
    const std::uint64_t before = occupied_[word] & (BitLayout::bit(local) - 1);
    return normals_[rank_of_word_[word] + static_cast<std::uint32_t>(std::popcount(before))];
  }
  [[nodiscard]] NormalTable table() const {
    return {occupied_, rank_of_word_.data(), normals_.empty() ? nullptr : normals_.data()->data(),
            static_cast<std::size_t>(layout_.size.y()), static_cast<std::size_t>(layout_.words_per_row)};
  }

 private:
  BitLayout layout_;
  const std::uint64_t* occupied_;
  std::vector<std::uint32_t> rank_of_word_;  // occupied voxels before each word
  std::vector<Vec3> normals_;
};

}  // namespace vantage
