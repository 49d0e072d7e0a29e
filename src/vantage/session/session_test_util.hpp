#pragma once

#include "vantage/session/session.hpp"

// Scans that the tests of sessions make up.
namespace vantage {

inline ScanPlanningOptions small_options() {
  ScanPlanningOptions options;
  options.scene.box = Eigen::Matrix<double, 6, 1>{{0.0, 0.0, 0.0, 1.0, 1.0, 1.0}};
  options.scene.voxel = 0.1;
  options.scene.views = 20;
  options.scene.registration = "none";
  return options;
}

/// What a sensor of 40x40 pixels measures where `depth_of(ray)`, along the axis, says what a ray in the world meets.
inline SessionScan scan_from(const View& view, const auto& depth_of) {
  RangeImage image{camera_from_apertures(radians(45), radians(45), {40, 40}), {}};
  image.camera.max_depth = 4.5;
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      image.depth.push_back(
          depth_of(view.world_from_sensor.linear() * point_in_sensor(image.camera.rays(), column, row, 1)));
    }
  }
  return {"scan", view, scan_of(std::move(image)), std::nullopt};
}

/// A square plate of 0.4 m in the middle of the box that faces the sensor; what is beside it is not met.
inline SessionScan plate_from(const Vec3& position) {
  const Vec3 normal = position.normalized();
  return scan_from(view_towards(position, Vec3::Zero()), [&](const Vec3& ray) {
    const double depth = -normal.dot(position) / normal.dot(ray);
    const Vec3 hit = position + depth * ray;
    return hit.cwiseAbs().maxCoeff() < 0.2 ? static_cast<float>(depth) : RangeImage::no_return;
  });
}

}  // namespace vantage
