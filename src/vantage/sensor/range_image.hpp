#pragma once

#include <limits>
#include <vector>

#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// Depth along the viewing axis for every pixel, row by row, metres. 0 = unknown (says nothing), infinity = the sensor
/// tells that nothing is there up to its far limit.
struct RangeImage {
  static constexpr float unknown = 0;
  static constexpr float no_return = std::numeric_limits<float>::infinity();

  RangeCamera camera;
  std::vector<float> depth;

  [[nodiscard]] float at(int column, int row) const {
    return depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.resolution.columns) +
                 static_cast<std::size_t>(column)];
  }
  /// True where the pixel holds a measured surface point.
  [[nodiscard]] static bool is_hit(float depth_value) { return depth_value > 0 && depth_value < no_return; }
  /// Throws InputError where sizes disagree or a depth is negative or not a number.
  void validate() const;
};

/// The point of pixel (column, row) at `depth` in the sensor frame.
[[nodiscard]] inline Vec3 point_in_sensor(const RayGrid& rays, int column, int row, double depth) {
  return {rays.x(column) * depth, rays.y(row) * depth, depth};
}

struct RangeNormalOptions {
  /// A neighbour farther in depth than this many times the pixel's own footprint lies on another surface.
  double max_step_in_footprints = 12;

  void validate() const;
};

/// Unit normals of a range image in the sensor frame, facing the sensor, one per pixel: from the cross product of the
/// differences to the nearest neighbours along the row and the column. (0,0,0) where the pixel is no hit or has no
/// neighbour on the same surface in either direction.
[[nodiscard]] std::vector<Vec3f> range_image_normals(const RangeImage& image, const RangeNormalOptions& options = {});

}  // namespace vantage
