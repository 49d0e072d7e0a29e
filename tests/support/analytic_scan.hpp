#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage::test {

/// Signed distance to a solid in world coordinates, metres: negative inside, never larger than the true distance.
using Solid = std::function<double(const Vec3&)>;

inline Solid sphere(const Vec3& center, double radius) {
  return [=](const Vec3& point) { return (point - center).norm() - radius; };
}

inline Solid box(const Vec3& center, const Vec3& size) {
  return [=](const Vec3& point) {
    const Vec3 outside = (point - center).cwiseAbs() - size / 2;
    return outside.cwiseMax(0.0).norm() + std::min(0.0, outside.maxCoeff());
  };
}

/// Everything below the plane z = height.
inline Solid ground(double height) {
  return [=](const Vec3& point) { return point.z() - height; };
}

inline Solid cylinder(double radius, double length) {
  return [=](const Vec3& point) { return std::max(point.head<2>().norm() - radius, std::abs(point.z()) - length / 2); };
}

inline Solid both(const Solid& a, const Solid& b) {
  return [=](const Vec3& point) { return std::min(a(point), b(point)); };
}

/// An L of two bars with different lengths: no symmetry turns or shifts it into itself.
inline Solid l_shape(double size) {
  return both(box(Vec3(0, 0, 0), size * Vec3(1, 0.3, 0.4)),
              box(size * Vec3(0.35, 0.35, 0.1), size * Vec3(0.3, 0.6, 0.25)));
}

/// Balls and bars without any symmetry, with edges and curved parts on all sides.
inline Solid knobbly(double size) {
  const Solid bars = both(l_shape(size), box(size * Vec3(-0.3, -0.1, -0.3), size * Vec3(0.25, 0.4, 0.3)));
  const Solid balls = both(
      both(sphere(size * Vec3(-0.25, 0.2, 0.2), 0.2 * size), sphere(size * Vec3(0.1, -0.15, -0.25), 0.18 * size)),
      both(sphere(size * Vec3(0.45, -0.1, 0.15), 0.15 * size), sphere(size * Vec3(0.05, -0.2, 0.25), 0.12 * size)));
  return both(bars, balls);
}

/// What a noise-free camera at `view` measures of the solid, by sphere tracing. Depths are exact to a nanometre.
inline RangeImage scan_solid(const Solid& solid, const RangeCamera& camera, const View& view) {
  RangeImage image{camera, {}};
  const RayGrid rays = camera.rays();
  for (int row = 0; row < camera.resolution.rows; ++row) {
    for (int column = 0; column < camera.resolution.columns; ++column) {
      const Vec3 direction = view.world_from_sensor.linear() * Vec3(rays.x(column), rays.y(row), 1);
      const double length = direction.norm();
      double depth = camera.min_depth, gap = 1;
      while (gap > 1e-9 && depth < camera.max_depth) {
        gap = solid(view.position() + depth * direction);
        depth += gap / length;
      }
      image.depth.push_back(gap > 1e-9 ? RangeImage::no_return : static_cast<float>(depth));
    }
  }
  return image;
}

}  // namespace vantage::test
