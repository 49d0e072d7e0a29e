#include "vantage/registration/model_surface.hpp"

#include <algorithm>
#include <limits>

namespace vantage {
namespace {

/// How alike two sensors see: the distance of their positions plus that of points a metre ahead.
double difference(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() + (a * Vec3(0, 0, 1) - b * Vec3(0, 0, 1)).norm();
}

}  // namespace

void RegisteredSurface::merge(const ScanSurface& scan, const Pose& world_from_sensor) {
  if (scan.samples.empty()) return;
  if (!surfels_) surfels_.emplace(scan.spacing);
  sigma_ = std::max(sigma_, scan.sigma);
  for (const SurfaceSample& sample : scan.samples) {
    surfels_->add({world_from_sensor * sample.point, world_from_sensor.linear() * sample.normal, sample.sigma});
  }
  if (scan.free_space) keep(*scan.free_space, world_from_sensor);
}

void RegisteredSurface::keep(const FreeSpace& space, const Pose& world_from_sensor) {
  free_spaces_.push_back({space, world_from_sensor, world_from_sensor.inverse()});
  if (free_spaces_.size() <= most_free_spaces) return;
  // One of the two that see most alike goes: the later.
  std::size_t redundant = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < free_spaces_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double between = difference(free_spaces_[i].world_from_sensor, free_spaces_[j].world_from_sensor);
      if (between < least) {
        least = between;
        redundant = i;
      }
    }
  }
  free_spaces_.erase(free_spaces_.begin() + static_cast<std::ptrdiff_t>(redundant));
}

}  // namespace vantage
