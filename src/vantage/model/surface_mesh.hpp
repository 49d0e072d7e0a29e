#pragma once

#include <cstddef>
#include <optional>

#include "vantage/core/point_cloud.hpp"
#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

struct SurfaceMeshOptions {
  /// Side of the lattice cells from which the surface is drawn, metres: edges come out about this long and walls
  /// thinner than it are lost. Twice the distance between neighbouring points where not given.
  std::optional<double> cell;
  /// Where the cloud would need more surface cells than this, the cells are made larger.
  std::size_t most_cells = 100000;

  /// Throws InputError naming the field and its value.
  void validate() const;
};

/// A triangle mesh through oriented points: the zero set of their moving-least-squares planes (Kolluri 2005), cut into
/// a surface net (Gibson 1998). Triangles face where the normals point; the surface stays open where no points are.
/// Points without a normal are left out; without any point the mesh is empty. Same bytes for any number of threads.
[[nodiscard]] TriangleMesh surface_mesh(const PointCloud& cloud, const SurfaceMeshOptions& options = {});

}  // namespace vantage
