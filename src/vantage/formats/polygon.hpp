#pragma once

#include <span>
#include <string>
#include <vector>

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// Appends the polygon with these corners (indices of the mesh's vertices) as triangles of the same orientation. Convex
/// polygons become a fan, others are cut ear by ear. Repeated corners and polygons with fewer than three different ones
/// add nothing. Throws InputError with `name` and `face` where a polygon that is not convex has more than 100 corners.
void append_polygon(TriangleMesh& mesh, std::span<const int> corners, const std::string& name, std::size_t face);

}  // namespace vantage
