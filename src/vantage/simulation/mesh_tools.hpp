#pragma once

#include <string>
#include <vector>

#include "vantage/core/random.hpp"
#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// Throws InputError that starts with `name` where the mesh cannot be scanned: no triangles, corners that are not
/// vertices, coordinates that are not finite numbers, no surface area, or a largest side outside 1e-6 to 1e6.
void check_mesh(const TriangleMesh& mesh, const std::string& name);

/// The mesh with the centre of its bounding box at the origin and a largest side of `largest_side` metres. Throws
/// InputError where the size is not within 1 mm and 1 km or the mesh has no extent.
[[nodiscard]] TriangleMesh centred_and_scaled(TriangleMesh mesh, double largest_side);

/// Twice the area times the normal: the cross product of two edges.
[[nodiscard]] Vec3 area_vector(const TriangleMesh& mesh, std::size_t triangle);

/// Total area of all triangles, both sides counted once; square metres.
[[nodiscard]] double surface_area(const TriangleMesh& mesh);

/// Signed volume: positive for a closed mesh whose triangles face outwards. Cubic metres.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

/// A point on a surface with the unit normal of its triangle.
struct MeshSample {
  Vec3 point;
  Vec3 normal;
  int triangle;
};

/// `count` points that stand for equal areas. The points are taken at equal steps of area along the triangles and
/// spread within a triangle by a sequence of low discrepancy (Roberts' R2), which leaves far less variance than
/// independent points. Throws InputError where count is not positive or the mesh has no area.
[[nodiscard]] std::vector<MeshSample> sample_surface(const TriangleMesh& mesh, int count, Random& random);

}  // namespace vantage
