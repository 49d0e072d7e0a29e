#pragma once

#include <Eigen/StdVector>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A place and orientation of the depth sensor. Sensor axes: x right, y down, z forward (the viewing axis).
struct View {
  Pose world_from_sensor = Pose::Identity();

  [[nodiscard]] Vec3 position() const { return world_from_sensor.translation(); }
  [[nodiscard]] Vec3 axis() const { return world_from_sensor.linear().col(2); }
};

[[nodiscard]] inline View view_towards(const Vec3& position, const Vec3& target) { return {look_at(position, target)}; }

}  // namespace vantage
