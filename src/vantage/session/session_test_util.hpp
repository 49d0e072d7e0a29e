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

inline bool same_map(const VoxelMap& a, const VoxelMap& b) {
  const IndexBox& box = a.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Index3 voxel(x, y, z);
        if (a.label(voxel) != b.label(voxel)) return false;
        const SurfaceVoxel *left = a.surface(voxel), *right = b.surface(voxel);
        if (left != nullptr && (left->normal_sum != right->normal_sum || left->quality != right->quality)) return false;
      }
    }
  }
  return true;
}

}  // namespace vantage
