#include "vantage/visibility/surface_normals.hpp"

namespace vantage {

SurfaceNormals::SurfaceNormals(const VoxelMap& map)
    : layout_(map.layout()), occupied_(map.occupied().words.data()), rank_of_word_(map.layout().words()) {
  std::uint32_t rank = 0;
  for (std::size_t word = 0; word < rank_of_word_.size(); ++word) {
    rank_of_word_[word] = rank;
    rank += static_cast<std::uint32_t>(std::popcount(occupied_[word]));
  }
  normals_.reserve(rank);
  for (const Index3& voxel : map.occupied_voxels()) normals_.push_back(map.surface(voxel)->normal());
}

}  // namespace vantage
