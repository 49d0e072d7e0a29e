#include "vantage/registration/fusion.hpp"

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {

FusedCloud::FusedCloud(double spacing) : lattice_{spacing} {
  require(spacing > 0 && std::isfinite(spacing), "fused cloud: spacing = ", spacing, " m: must be positive");
}

void FusedCloud::merge(const PointCloud& scan_in_sensor, const Pose& world_from_sensor) {
  require(scan_in_sensor.points.size() == scan_in_sensor.normals.size(), "fused cloud: ", scan_in_sensor.points.size(),
          " points with ", scan_in_sensor.normals.size(), " normals; must be as many");
  for (std::size_t i = 0; i < scan_in_sensor.size(); ++i) {
    const Vec3 point = world_from_sensor * scan_in_sensor.points[i];
    const Vec3 normal = world_from_sensor.linear() * scan_in_sensor.normals[i];
    const double quality = std::max(0.0, -scan_in_sensor.normals[i].dot(scan_in_sensor.points[i].normalized()));
    const LatticeCell cell = lattice_.cell(point);
    const auto [entry, is_new] = first_.try_emplace(cell, static_cast<int>(cloud_.size()));
    int last = -1;
    int same_side = is_new ? -1 : entry->second;
    while (same_side >= 0 && cloud_.normals[static_cast<std::size_t>(same_side)].dot(normal) < -0.5) {
      last = same_side;
      same_side = next_[static_cast<std::size_t>(same_side)];
    }
    if (same_side < 0) {
      if (last >= 0) next_[static_cast<std::size_t>(last)] = static_cast<int>(cloud_.size());
      cloud_.add(point, normal);
      quality_.push_back(quality);
      next_.push_back(-1);
    } else if (const auto kept = static_cast<std::size_t>(same_side); quality > quality_[kept]) {
      cloud_.points[kept] = point;
      cloud_.normals[kept] = normal;
      quality_[kept] = quality;
    }
  }
}

}  // namespace vantage
