#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// At most about `max_triangles` triangles of the same shape: vertices that share a cell of the finest sufficient
/// lattice become one, in their middle; triangles that collapse fall out. A smaller mesh is returned as it is.
[[nodiscard]] TriangleMesh thinned(const TriangleMesh& mesh, std::size_t max_triangles);

/// Points on a lattice of 65536 steps along the longest side of their box (docs/report-data.md).
struct QuantisedPoints {
  Vec3 origin = Vec3::Zero();
  double step = 1;                    // metres
  std::vector<std::uint16_t> values;  // three per point
};
[[nodiscard]] QuantisedPoints quantised(const std::vector<Vec3>& points);

[[nodiscard]] nlohmann::ordered_json point_json(const Vec3& point);

/// The `mesh` object of docs/report-data.md, or null for an empty mesh.
[[nodiscard]] nlohmann::ordered_json mesh_json(const TriangleMesh& mesh, std::size_t max_triangles);
/// The `cloud` object, or null for an empty cloud; `scan_of_point` may be empty. Keeps every k-th point.
[[nodiscard]] nlohmann::ordered_json cloud_json(const PointCloud& cloud,
                                                const std::vector<std::uint16_t>& scan_of_point,
                                                std::size_t max_points);

}  // namespace vantage
