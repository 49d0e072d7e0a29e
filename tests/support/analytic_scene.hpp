#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "vantage/core/random.hpp"
#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage::test {

/// Solid shapes with closed formulas for rays: a world for tests that needs no meshes.
struct AnalyticScene {
  struct Sphere {
    Vec3 center;
    double radius;
  };

  std::vector<Sphere> spheres;
  std::vector<Box3> boxes;

  /// Least t > 0 at which the ray from outside enters a shape.
  [[nodiscard]] std::optional<double> first_hit(const Vec3& origin, const Vec3& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [center, radius] : spheres) {
      const Vec3 offset = origin - center;
      const double a = direction.squaredNorm();
      const double b = offset.dot(direction);
      const double discriminant = b * b - a * (offset.squaredNorm() - radius * radius);
      if (discriminant < 0) continue;
      const double t = (-b - std::sqrt(discriminant)) / a;
      if (t > 0) nearest = std::min(nearest, t);
    }
    for (const Box3& box : boxes) {
      double enter = 0;
      double leave = nearest;
      for (int a = 0; a < 3; ++a) {
        const double one = (box.min()[a] - origin[a]) / direction[a];
        const double other = (box.max()[a] - origin[a]) / direction[a];
        if (direction[a] == 0) {
          if (origin[a] < box.min()[a] || origin[a] > box.max()[a]) leave = -1;
          continue;
        }
        enter = std::max(enter, std::min(one, other));
        leave = std::min(leave, std::max(one, other));
      }
      if (enter > 0 && enter < leave) nearest = enter;
    }
    if (nearest == std::numeric_limits<double>::infinity()) return std::nullopt;
    return nearest;
  }

  /// What the camera measures: hits up to its far limit, no-return elsewhere.
  [[nodiscard]] RangeImage scan(const RangeCamera& camera, const View& view) const {
    RangeImage image;
    image.camera = camera;
    const RayGrid rays = camera.rays();
    image.depth.reserve(static_cast<std::size_t>(rays.resolution.rays()));
    for (int row = 0; row < rays.resolution.rows; ++row) {
      for (int column = 0; column < rays.resolution.columns; ++column) {
        const Vec3 direction = view.world_from_sensor.linear() * Vec3(rays.x(column), rays.y(row), 1);
        const std::optional<double> depth = first_hit(view.position(), direction);
        const bool in_range = depth && *depth >= camera.min_depth && *depth <= camera.max_depth;
        image.depth.push_back(in_range ? static_cast<float>(*depth) : RangeImage::no_return);
      }
    }
    return image;
  }
};

/// Gaussian noise on hits, then a share of pixels made unknown and a share made no-return.
inline void disturb(RangeImage& image, double sigma, double unknown_share, double no_return_share, Random& random) {
  for (float& depth : image.depth) {
    if (RangeImage::is_hit(depth))
      depth = static_cast<float>(std::max(1e-4, static_cast<double>(depth) + sigma * random.normal()));
    const double kind = random.uniform();
    if (kind < unknown_share) depth = RangeImage::unknown;
    if (kind > 1 - no_return_share) depth = RangeImage::no_return;
  }
}

}  // namespace vantage::test
