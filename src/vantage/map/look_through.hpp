#pragma once

#include "vantage/map/lattice_projection.hpp"
#include "vantage/map/scan_limits.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Finds the touched voxels that a pinhole scan looks through and counts that against them, by the definition at
/// integrate_exactly. Few voxels are touched and most of those are seen or hidden, so the nearest ray mostly decides.
class LookThrough {
 public:
  /// Keeps references to all arguments.
  LookThrough(VoxelMap& map, const RangeCamera& camera, const View& view, const StepCounts& steps,
              const ScanLimits& limits, const LatticeProjection& projection);

  static constexpr int side = 4;  // voxels of a block
  /// All blocks of the layer that begins at local index z. Layers may run at the same time. Returns how many occupied
  /// voxels became empty.
  int count_layer(int z);

 private:
  struct Block {
    Index3 low, high;
    std::uint64_t columns;  // bits of its rows in their words
  };

  int count_block(const Block& block);
  [[nodiscard]] bool looks_through(const Index3& voxel, bool is_dense) const;
  [[nodiscard]] bool passes(const Index3& voxel, int column, int row) const;

  VoxelMap& map_;
  double near_;
  RayGrid rays_;
  Mat3 rotation_;
  Vec3 eye_;
  const StepCounts& steps_;
  const ScanLimits& limits_;
  const LatticeProjection& projection_;
};

}  // namespace vantage
