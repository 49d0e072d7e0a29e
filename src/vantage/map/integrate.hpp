#pragma once

#include <span>

#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {

/// What a scan changed in the map.
struct IntegrationReport {
  std::int64_t points_in_enclosure = 0;
  std::int64_t new_occupied = 0;
  std::int64_t taken_back = 0;  // occupied voxels that became empty (evidence)
};

/// Updates the labels with one scan (paper, section 4; spec, section 1), in passes over the whole scan: voxels of hits
/// become occupied; voxels that a ray crosses before its end become empty; unmarked voxels behind a hit become
/// occluded; occplane follows. "Before" and "behind" are decided by the steps from the camera's voxel, which grow by
/// one per crossing. This is the definition: exact rays through all voxels. Also serves sensors without a pinhole.
///
/// By the rule `evidence` points count as support (struct VoxelEvidence), and a voxel becomes occupied where they are
/// more than a stray one and no more scans looked through it than saw it. A scan looks through a touched voxel where at
/// least one ray passes it and all rays that do end more than steps_looked_through steps behind it; where more scans
/// have looked through than seen it, it becomes empty before the carving. An unmarked voxel that holds points but is
/// not occupied becomes occluded.
IntegrationReport integrate_exactly(VoxelMap& map, std::span<const SightLine> lines);

/// The same map for a pinhole range image by the fast path.
IntegrationReport integrate(VoxelMap& map, const RangeImage& image, std::span<const Vec3f> normals_in_sensor,
                            const View& view, QualityReference reference = QualityReference::axis);

}  // namespace vantage
