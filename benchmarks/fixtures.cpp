#include "fixtures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "vantage/map/integrate.hpp"

namespace vantage::bench {
namespace {

/// Distance from the surface of the mug, at most; negative inside.
double distance_to_mug(const Vec3& point) {
  constexpr double radius = 0.26, height = 0.7, wall = 0.04, bottom = 0.05;
  const double from_axis = std::hypot(point.x(), point.y());
  const auto cylinder = [&](double r, double low, double high) {
    return std::max({from_axis - r, low - point.z(), point.z() - high});
  };
  const double body = std::max(cylinder(radius, -height / 2, height / 2),
                               -cylinder(radius - wall, -height / 2 + bottom, height));  // minus the hollow
  const Vec3 from_handle = point - Vec3(radius, 0, 0);
  const double ring = std::hypot(std::hypot(from_handle.x(), from_handle.z()) - 0.2, from_handle.y()) - 0.035;
  return std::min(body, std::max(ring, radius - wall / 2 - from_axis));
}

double depth_along(const Vec3& origin, const Vec3& direction, double max_depth) {
  const double length = direction.norm();
  for (double depth = 0; depth < max_depth;) {
    const double distance = distance_to_mug(origin + depth * direction);
    if (distance < 1e-6) return depth;
    depth += distance / length;
  }
  return RangeImage::no_return;
}

VoxelMap scanned_map(int scans, SceneSize size) {
  VoxelMap map(scene_options(size));
  const std::vector<View> views = scan_views();
  for (int i = 0; i < scans; ++i) {
    const Scan scan = scan_of_mug(paper_camera(), views[static_cast<std::size_t>(i)]);
    integrate(map, scan.image, scan.normals, scan.view);
  }
  return map;
}

}  // namespace

SceneOptions scene_options(SceneSize size) {
  SceneOptions options;
  options.voxel_length = 4.1 / size.scene;
  options.scene_size = Index3::Constant(size.scene);
  options.enclosure_size = Index3::Constant(size.enclosure);
  return options;
}

RangeCamera paper_camera(Resolution resolution) { return camera_from_apertures(radians(45), radians(45), resolution); }

Scan scan_of_mug(const RangeCamera& camera, const View& view) {
  Scan scan{{camera, {}}, {}, view};
  const RayGrid rays = camera.rays();
  const Mat3 rotation = view.world_from_sensor.linear();
  for (int row = 0; row < camera.resolution.rows; ++row) {
    for (int column = 0; column < camera.resolution.columns; ++column) {
      const Vec3 direction = ray_direction(rotation, rays.x(column), rays.y(row));
      scan.image.depth.push_back(static_cast<float>(depth_along(view.position(), direction, camera.max_depth)));
    }
  }
  scan.normals = range_image_normals(scan.image);
  return scan;
}

std::vector<View> scan_views() {
  std::vector<View> views;
  for (const Vec3& direction : {Vec3(1, 0.3, 0.4), Vec3(-0.5, 0.9, 0.5), Vec3(-0.6, -0.8, 0.3), Vec3(0.2, -0.3, 1)}) {
    views.push_back(view_towards(2 * direction.normalized(), Vec3::Zero()));
  }
  return views;
}

const VoxelMap& map_after_scans(int scans, SceneSize size) {
  static std::map<std::tuple<int, int, int>, VoxelMap> maps;
  const std::tuple key{scans, size.scene, size.enclosure};
  const auto found = maps.find(key);
  return found != maps.end() ? found->second : maps.emplace(key, scanned_map(scans, size)).first->second;
}

void report_differing(benchmark::State& state, std::int64_t differing) {
  state.counters["differing"] = static_cast<double>(differing);
  if (differing != 0) state.SkipWithError("differs from the reference");
}

}  // namespace vantage::bench
