#pragma once

#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A surface as triangles, counter-clockwise seen from outside. Metres.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Index3> triangles;

  [[nodiscard]] Vec3 corner(std::size_t triangle, int k) const {
    return vertices[static_cast<std::size_t>(triangles[triangle][k])];
  }
  [[nodiscard]] Box3 box() const {
    Box3 bounds;
    for (const Vec3& vertex : vertices) bounds.extend(vertex);
    return bounds;
  }
};

}  // namespace vantage
