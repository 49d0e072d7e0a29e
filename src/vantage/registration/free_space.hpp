#pragma once

#include <span>
#include <vector>

#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// A range image and where it was taken.
struct PosedImage {
  RangeImage image;
  Pose world_from_sensor = Pose::Identity();
};

/// The space that a range image shows to be empty, less a safety margin around every surface and every unknown pixel:
/// points in it are nowhere near anything the sensor met.
class FreeSpace {
 public:
  /// `margin`: metres that a point must keep from the surfaces of the image, along the ray and across it.
  FreeSpace(const RangeImage& image, double margin);

  /// True where the point, in the sensor frame, lies inside the image and well in front of all that it shows.
  [[nodiscard]] bool contains(const Vec3& point_in_sensor) const;
  /// Share of the points (world frame) that lie in free space when the image is taken from a pose.
  [[nodiscard]] double share_inside(std::span<const Vec3> points, const Pose& world_from_sensor) const;

 private:
  RayGrid rays_;
  double min_depth_, max_depth_;
  double margin_;
  std::vector<float> nearest_;  // least depth around each pixel
};

}  // namespace vantage
