#pragma once

#include <filesystem>
#include <string>

#include "vantage/map/voxel_map.hpp"

namespace vantage {

/// How the voxels of a map lie in the lattice of an OctoMap, whose cell borders are the multiples of its resolution.
struct OctomapLattice {
  /// Cells per voxel and axis: 1 where the map's voxel borders fall on such multiples, 2 where they fall half-way
  /// between them (the paper's scene, an odd number of voxels around the origin).
  int cells_per_voxel = 1;
  double resolution = 0;  // metres
  /// Where the borders lie elsewhere, the map is moved to the nearest cells: by this much, at most half a cell per
  /// axis.
  Vec3 shift = Vec3::Zero();
};

[[nodiscard]] OctomapLattice octomap_lattice(const Grid& grid);

/// The enclosure of the map as an OctoMap `.bt` (binary tree): occupied voxels are occupied, empty ones free, all
/// others and everything outside of the enclosure unknown; nodes with eight equal leaves are pruned. Throws InputError
/// where the enclosure is too far from the origin for the 65,536 cells per axis that OctoMap has.
[[nodiscard]] std::string octomap_bytes(const VoxelMap& map);
/// Writes it to a file, atomically.
void write_octomap(const VoxelMap& map, const std::filesystem::path& path);

}  // namespace vantage
