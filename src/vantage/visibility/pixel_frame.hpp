#pragma once

#include "vantage/map/voxel_ray.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {

/// A view's ray grid over the voxels of an enclosure. Voxel indices are local to the enclosure; offsets are from the
/// camera, in voxels; pixel coordinates are continuous, with whole numbers at the rays.
struct PixelFrame {
  Grid grid;
  IndexBox enclosure;
  Resolution resolution;
  RayGrid rays;
  Mat3 rotation;             // world from sensor
  Vec3 origin;               // of the camera, metres
  Index3 origin_cell;        // in the scene
  double near = 0, far = 0;  // metres along the axis

  /// Direction of ray (column, row) = directions * (column, row, 1), to rounding.
  Mat3 directions;
  /// Takes an offset to (column * depth, row * depth, depth), depth in voxels.
  Mat3 pixel_from_offset;
  /// The most by which depth, column * depth and row * depth differ between a voxel's centre and its corners.
  Vec3 half_extent;
  /// Largest component of any ray's direction.
  double longest = 0;

  PixelFrame(const Grid& map_grid, const IndexBox& map_enclosure, const RangeCamera& camera, const View& view,
             Resolution ray_resolution);

  /// False where the pose is no pose; then only rays can tell what is visible.
  [[nodiscard]] bool is_regular() const { return pixel_from_offset.allFinite(); }
  /// Offset of lattice plane k of an axis (the lower face of voxel k).
  [[nodiscard]] double plane(int axis, int k) const {
    return (grid.plane(axis, enclosure.min[axis] + k) - origin[axis]) / grid.length;
  }
  [[nodiscard]] Vec3 center(const Index3& voxel) const {
    return {plane(0, voxel.x()) + 0.5, plane(1, voxel.y()) + 0.5, plane(2, voxel.z()) + 0.5};
  }
  [[nodiscard]] Index3 local_cell() const { return origin_cell - enclosure.min; }
  /// The exact test: does the ray of this pixel pass the voxel within the depth limits?
  [[nodiscard]] bool ray_passes(int column, int row, const Index3& voxel) const;
};

}  // namespace vantage
