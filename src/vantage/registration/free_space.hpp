#pragma once

#include <span>
#include <vector>

#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// The space that a range image shows to be empty, less a safety margin around every surface and every unknown pixel:
/// points in it are nowhere near anything the sensor met. Kept at a resolution of at most 160 pixels either way.
class FreeSpace {
 public:
  /// The margin along the ray is five standard deviations of the depth there, and across it (and at least along it)
  /// `blur`: how far a point that is asked about may lie beside where it was measured, metres.
  FreeSpace(const RangeImage& image, const SensorModel& sensor, double blur);

  enum class Answer { unknown, surface, free };
  /// What the image says of a point in the sensor frame: that it lies well in front of all that the sensor met there
  /// (free), about where the sensor met something (surface), or nothing (behind a surface, outside of the image).
  [[nodiscard]] Answer at(const Vec3& point_in_sensor) const;
  [[nodiscard]] bool contains(const Vec3& point_in_sensor) const { return at(point_in_sensor) == Answer::free; }

 private:
  RayGrid rays_;  // of the reduced image
  double min_depth_, max_depth_;
  SensorModel sensor_;
  double blur_;
  std::vector<float> nearest_, farthest_;  // least and largest depth around each pixel
};

}  // namespace vantage
