#pragma once

#include "vantage/map/integrate.hpp"
#include "vantage/map/lattice_projection.hpp"
#include "vantage/map/scan_limits.hpp"

namespace vantage {

/// Where `integrate` takes integrate_exactly: the pixels are so coarse that there are fewer rays than voxels, or the
/// camera is inside the enclosure or so close that the whole image may see one voxel.
[[nodiscard]] bool rays_are_faster(const VoxelMap& map, const RangeCamera& camera, const View& view);

/// Integrates pinhole scans voxel by voxel instead of ray by ray, with the same result as integrate_exactly to the
/// last bit. Keeps its scratch memory between scans. Runs in parallel; any number of threads gives the same bits.
///
/// A voxel's steps from the camera's voxel tell on every ray alike whether it lies before or behind the ray's hit. So a
/// block of voxels is emptied, occluded or left alone at once where the extremes of the limits over the pixels that may
/// see it agree; else each of its voxels asks first the pixel nearest to its centre, then every pixel that may see it,
/// with the exact test of ray against voxel.
class Integrator {
 public:
  /// `normals_in_sensor`: one per pixel, zero where unknown, or none at all. Throws InputError where sizes disagree.
  IntegrationReport integrate(VoxelMap& map, const RangeImage& image, std::span<const Vec3f> normals_in_sensor,
                              const View& view, QualityReference reference = QualityReference::axis);

 private:
  /// Counts the look-throughs of the scan in `limits_`; how many occupied voxels became empty by it.
  [[nodiscard]] std::int64_t look_through(VoxelMap& map, const RangeCamera& camera, const View& view,
                                          const StepCounts& steps) const;

  ScanLimits limits_;
  LatticeProjection projection_;
};

}  // namespace vantage
