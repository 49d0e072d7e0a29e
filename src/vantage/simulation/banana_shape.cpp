#include <array>
#include <cmath>

#include "vantage/simulation/object_shapes.hpp"
#include "vantage/simulation/surface_builder.hpp"

namespace vantage {
namespace {

constexpr int banana_segments = 60;
constexpr double arc_radius = 0.62;  // of the middle line, in units of its length
constexpr double banana_half_width = 0.0885;

/// Share of the full thickness along the middle line: tip, body, neck, stem.
std::vector<OutlinePoint> thickness_along_length() {
  const std::array<OutlinePoint, 17> corners{{{0, 0.13},
                                              {0.012, 0.17},
                                              {0.03, 0.21},
                                              {0.05, 0.31},
                                              {0.09, 0.52},
                                              {0.15, 0.74},
                                              {0.24, 0.92},
                                              {0.36, 1.0},
                                              {0.48, 1.0},
                                              {0.6, 0.95},
                                              {0.7, 0.84},
                                              {0.78, 0.66},
                                              {0.84, 0.46},
                                              {0.88, 0.32},
                                              {0.92, 0.25},
                                              {0.97, 0.24},
                                              {1.0, 0.27}}};
  return smooth_curve(corners, 6);
}

/// Distance of the skin from the middle line: a pentagon with rounded edges in the body, round at the ends.
double skin(double angle, double thickness) {
  const double edges = 0.045 * thickness * thickness;
  return banana_half_width * thickness * (1 + edges * std::cos(5 * angle));
}

}  // namespace

// Sections across a circular arc in the x-z plane, from the tip to the stem.
TriangleMesh banana_shape() {
  SurfaceBuilder surface;
  Ring last;
  Vec3 middle;
  const std::vector<OutlinePoint> sections = thickness_along_length();
  for (const OutlinePoint& section : sections) {
    // The stem bends back a little: the arc is tightest in the body.
    const double along = section.x() - 0.5;
    const double turn = along / arc_radius;
    const Vec3 out(std::cos(turn), 0, std::sin(turn));
    const Vec3 across = Vec3::UnitY();
    middle = arc_radius * out;
    std::vector<Vec3> points;
    for (int k = 0; k < banana_segments; ++k) {
      const double angle = 2 * std::numbers::pi * k / banana_segments;
      const double radius = skin(angle, section.y());
      points.emplace_back(middle + radius * (std::cos(angle) * out + std::sin(angle) * across));
    }
    Ring next = surface.add_ring(points);
    if (last.empty()) {
      surface.close_start(middle, next);
    } else {
      surface.join(last, next);
    }
    last = std::move(next);
  }
  surface.close_end(last, middle);
  return std::move(surface).take();
}

}  // namespace vantage
