#include "vantage/robot/reach.hpp"

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// The first voxel of the enclosure that is not empty and that a ball touches.
std::optional<Index3> touched_voxel(const VoxelMap& map, const Vec3& center, double radius) {
  const Index3 home = map.grid().index_of(center);
  if (map.label(home) != Label::empty) return home;
  const Box3 enclosure = map.grid().box(map.enclosure());
  if (radius <= 0 || enclosure.exteriorDistance(center) > radius) return std::nullopt;
  const Index3 first = map.grid().index_of(Vec3(center.array() - radius)).cwiseMax(map.enclosure().min);
  const Index3 last = map.grid().index_of(Vec3(center.array() + radius)).cwiseMin(map.enclosure().max);
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) {
        const Index3 index(x, y, z);
        if (map.label(index) == Label::empty) continue;
        if (map.grid().box({index, index}).exteriorDistance(center) <= radius) return index;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

void ReachOptions::validate() const {
  require(body_radius >= 0 && std::isfinite(body_radius), "body radius = ", body_radius, " m: must not be negative");
  require(!workspace || !workspace->isEmpty(), "workspace: the lower corner must be below the upper one on every axis");
  for (const Box3& obstacle : obstacles) {
    require(!obstacle.isEmpty(), "obstacle: its size must be positive on every axis");
  }
}

std::optional<std::string> why_infeasible(const VoxelMap& map, const View& view, const ReachOptions& options) {
  const Vec3 position = view.position();
  if (options.workspace && !options.workspace->contains(position)) return "outside the workspace";
  for (std::size_t i = 0; i < options.obstacles.size(); ++i) {
    if (options.obstacles[i].exteriorDistance(position) <= options.body_radius) {
      return concat("the body touches obstacle ", i + 1);
    }
  }
  if (const auto voxel = touched_voxel(map, position, options.body_radius)) {
    return concat("the body touches ", name(map.label(*voxel)), " voxel ", voxel->x(), ",", voxel->y(), ",",
                  voxel->z());
  }
  return std::nullopt;
}

}  // namespace vantage
