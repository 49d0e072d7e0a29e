#include "vantage/simulation/surface_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vantage {

int SurfaceBuilder::add_vertex(const Vec3& point) {
  mesh_.vertices.push_back(point);
  return static_cast<int>(mesh_.vertices.size()) - 1;
}

Ring SurfaceBuilder::add_ring(std::span<const Vec3> points) {
  Ring ring;
  ring.reserve(points.size());
  for (const Vec3& point : points) ring.push_back(add_vertex(point));
  return ring;
}

Ring SurfaceBuilder::add_circle(const OutlinePoint& radius_and_height, int segments) {
  Ring ring;
  for (int k = 0; k < segments; ++k) {
    const double angle = 2 * std::numbers::pi * k / segments;
    const double radius = radius_and_height.x();
    ring.push_back(add_vertex({radius * std::cos(angle), radius * std::sin(angle), radius_and_height.y()}));
  }
  return ring;
}

void SurfaceBuilder::close_start(const Vec3& apex, const Ring& first) {
  const int center = add_vertex(apex);
  for (std::size_t k = 0; k < first.size(); ++k) {
    mesh_.triangles.emplace_back(center, first[(k + 1) % first.size()], first[k]);
  }
}

void SurfaceBuilder::join(const Ring& from, const Ring& to) {
  for (std::size_t k = 0; k < from.size(); ++k) join_segment(from, to, k);
}

void SurfaceBuilder::join_segment(const Ring& from, const Ring& to, std::size_t k) {
  assert(from.size() == to.size());
  const std::size_t next = (k + 1) % from.size();
  mesh_.triangles.emplace_back(from[k], from[next], to[next]);
  mesh_.triangles.emplace_back(from[k], to[next], to[k]);
}

TriangleMesh SurfaceBuilder::take() && {
  TriangleMesh used;
  std::vector<int> new_number(mesh_.vertices.size(), -1);
  for (const Index3& triangle : mesh_.triangles) {
    Index3 renumbered;
    for (int k = 0; k < 3; ++k) {
      int& number = new_number[static_cast<std::size_t>(triangle[k])];
      if (number < 0) {
        number = static_cast<int>(used.vertices.size());
        used.vertices.push_back(point(triangle[k]));
      }
      renumbered[k] = number;
    }
    used.triangles.push_back(renumbered);
  }
  return used;
}

void SurfaceBuilder::close_end(const Ring& last, const Vec3& apex) {
  const int center = add_vertex(apex);
  for (std::size_t k = 0; k < last.size(); ++k) {
    mesh_.triangles.emplace_back(last[k], last[(k + 1) % last.size()], center);
  }
}

TriangleMesh solid_of_revolution(std::span<const OutlinePoint> outline, int segments) {
  assert(outline.size() >= 3 && outline.front().x() == 0 && outline.back().x() == 0);
  SurfaceBuilder surface;
  Ring last = surface.add_circle(outline[1], segments);
  surface.close_start({0, 0, outline.front().y()}, last);
  for (std::size_t i = 2; i + 1 < outline.size(); ++i) {
    Ring next = surface.add_circle(outline[i], segments);
    surface.join(last, next);
    last = std::move(next);
  }
  surface.close_end(last, {0, 0, outline.back().y()});
  return std::move(surface).take();
}

std::vector<OutlinePoint> arc(const OutlinePoint& center, double radius, double from, double to, int steps) {
  std::vector<OutlinePoint> points;
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    points.emplace_back(center + radius * OutlinePoint(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::vector<OutlinePoint> smooth_curve(std::span<const OutlinePoint> points, int steps) {
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  const auto at = [&](std::ptrdiff_t i) {
    return points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, count - 1))];
  };
  std::vector<OutlinePoint> curve;
  for (std::ptrdiff_t i = 0; i + 1 < count; ++i) {
    const OutlinePoint a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      curve.emplace_back(b + 0.5 * t * ((c - a) + t * ((2 * a - 5 * b + 4 * c - d) + t * (3 * (b - c) + d - a))));
    }
  }
  curve.push_back(points.back());
  return curve;
}

}  // namespace vantage
