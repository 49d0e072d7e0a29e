#pragma once

#include <optional>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// Columns and rows of a range image or of a ray tracing (the paper's RTR).
struct Resolution {
  int columns = 0;
  int rows = 0;

  [[nodiscard]] int rays() const { return columns * rows; }
  bool operator==(const Resolution&) const = default;
};

/// The rays of a pinhole sensor at some resolution, in the sensor frame. Ray (column, row) has the direction
/// (x(column), y(row), 1): its parameter t is the depth along the viewing axis in metres.
struct RayGrid {
  Resolution resolution;
  double x_middle = 0, x_half = 0;  // tangents
  double y_middle = 0, y_half = 0;

  [[nodiscard]] double x(int column) const {
    return x_middle + x_half * ((2.0 * column + 1) / resolution.columns - 1);  // spec: u = (2i+1)/C - 1
  }
  [[nodiscard]] double y(int row) const { return y_middle + y_half * ((2.0 * row + 1) / resolution.rows - 1); }
};

/// A pinhole depth camera: what it sees of the world and in how many rays.
struct RangeCamera {
  Resolution resolution{320, 320};
  /// Tangents of the angles from the axis to the image borders: x to the right, y down.
  double left = -0.41421356237309503, right = 0.41421356237309503;
  double top = -0.41421356237309503, bottom = 0.41421356237309503;
  /// Depth limits along the axis, metres.
  double min_depth = 0;
  double max_depth = 4.5;
  /// Largest angle between a surface's normal and the direction towards the sensor, radians; none by default.
  std::optional<double> max_incidence;

  /// Throws InputError naming the field and its value.
  void validate() const;
  /// The rays of this camera at another resolution; the field of view is the same.
  [[nodiscard]] RayGrid rays(Resolution ray_resolution) const;
  [[nodiscard]] RayGrid rays() const { return rays(resolution); }
  /// Full apertures in radians.
  [[nodiscard]] double horizontal_aperture() const;
  [[nodiscard]] double vertical_aperture() const;
};

/// A symmetric camera from its full apertures in radians (each in (0, pi)).
[[nodiscard]] RangeCamera camera_from_apertures(double horizontal, double vertical, Resolution resolution);

/// A camera from pinhole intrinsics in pixels; pixel centres lie at whole numbers.
[[nodiscard]] RangeCamera camera_from_intrinsics(double fx, double fy, double cx, double cy, Resolution resolution);

/// Eq. 14 of the paper: the lowest resolution at which neighbouring rays are one voxel apart at distance `distance`
/// (metres), rounded up per axis.
[[nodiscard]] Resolution ideal_resolution(const RangeCamera& camera, double voxel_length, double distance);

}  // namespace vantage
