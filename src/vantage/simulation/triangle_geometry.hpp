#pragma once

#include <optional>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// The three corners of a triangle, counter-clockwise seen from its front.
struct TriangleCorners {
  Vec3 a, b, c;
};

/// How a ray meets a triangle.
struct TriangleHit {
  double t = 0;           // in units of the ray's direction
  bool is_clear = false;  // from the front and strictly inside: no neighbour can claim the same ray
};

/// Whether the ray origin + t*direction, t > 0, meets the triangle, both sides and the border included. The signs of
/// the edges decide; two triangles with a common edge compute that edge from the same numbers with opposite signs, so
/// that no ray slips between them.
[[nodiscard]] std::optional<TriangleHit> meet(const TriangleCorners& triangle, const Vec3& origin,
                                              const Vec3& direction);

/// The point of the triangle that is nearest to `point`.
[[nodiscard]] Vec3 closest_point(const TriangleCorners& triangle, const Vec3& point);

}  // namespace vantage
