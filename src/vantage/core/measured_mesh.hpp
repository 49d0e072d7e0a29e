#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// A surface as it was measured: a mesh with what is known of each part of it.
struct MeasuredMesh {
  TriangleMesh mesh;
  std::vector<float> sigma;          // standard deviation along the normal, metres, one per vertex; 0 where not seen
  std::vector<std::uint8_t> is_cap;  // one per triangle: 1 where nobody saw the surface
  std::vector<std::array<std::uint8_t, 3>> colors;  // red, green and blue, one per vertex; empty: none

  [[nodiscard]] bool empty() const { return mesh.triangles.empty(); }
};

}  // namespace vantage
