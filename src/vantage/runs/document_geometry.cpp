#include "vantage/runs/document_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "vantage/core/error.hpp"
#include "vantage/files/packed_array.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// The mesh with all vertices of a lattice cell merged.
TriangleMesh clustered(const TriangleMesh& mesh, double cell) {
  const Vec3 origin = mesh.box().min();
  std::map<std::tuple<int, int, int>, int> vertex_of_cell;
  std::vector<int> merged(mesh.vertices.size());
  std::vector<int> count;
  TriangleMesh result;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Index3 at = ((mesh.vertices[i] - origin) / cell).array().floor().cast<int>();
    const auto next = static_cast<int>(result.vertices.size());
    const auto [entry, is_new] = vertex_of_cell.try_emplace({at.x(), at.y(), at.z()}, next);
    merged[i] = entry->second;
    if (is_new) {
      result.vertices.push_back(Vec3::Zero());
      count.push_back(0);
    }
    result.vertices[static_cast<std::size_t>(entry->second)] += mesh.vertices[i];
    ++count[static_cast<std::size_t>(entry->second)];
  }
  for (std::size_t i = 0; i < count.size(); ++i) result.vertices[i] /= count[i];
  for (const Index3& triangle : mesh.triangles) {
    const Index3 t = triangle.unaryExpr([&](int v) { return merged[static_cast<std::size_t>(v)]; });
    if (t.x() != t.y() && t.y() != t.z() && t.z() != t.x()) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

Json point_json(const Vec3& point) { return {point.x(), point.y(), point.z()}; }

TriangleMesh thinned(const TriangleMesh& mesh, std::size_t max_triangles) {
  if (mesh.triangles.size() <= max_triangles) return mesh;
  require(max_triangles > 0, "thinned mesh: max_triangles = 0, must be positive");
  double area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    area += (mesh.corner(i, 1) - mesh.corner(i, 0)).cross(mesh.corner(i, 2) - mesh.corner(i, 0)).norm() / 2;
  }
  // A surface of area A meets about A / cell^2 cells, each of which gives about two triangles.
  double cell = std::sqrt(2 * area / static_cast<double>(max_triangles));
  if (!(cell > 0)) cell = mesh.box().diagonal().norm() / 1024;
  TriangleMesh result = clustered(mesh, cell);
  while (result.triangles.size() > max_triangles) result = clustered(mesh, cell *= 1.15);
  return result;
}

QuantisedPoints quantised(const std::vector<Vec3>& points) {
  QuantisedPoints result;
  if (points.empty()) return result;
  Box3 box;
  for (const Vec3& point : points) box.extend(point);
  result.origin = box.min();
  const double side = box.sizes().maxCoeff();
  if (side > 0) result.step = side / 65535;
  result.values.reserve(3 * points.size());
  for (const Vec3& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::round((point[axis] - result.origin[axis]) / result.step);
      result.values.push_back(static_cast<std::uint16_t>(std::clamp(steps, 0.0, 65535.0)));
    }
  }
  return result;
}

Json mesh_json(const TriangleMesh& mesh, std::size_t max_triangles) {
  if (mesh.triangles.empty()) return nullptr;
  const TriangleMesh small = thinned(mesh, max_triangles);
  const QuantisedPoints vertices = quantised(small.vertices);
  std::vector<std::uint32_t> triangles;
  triangles.reserve(3 * small.triangles.size());
  for (const Index3& t : small.triangles) {
    for (int k = 0; k < 3; ++k) triangles.push_back(static_cast<std::uint32_t>(t[k]));
  }
  return {{"origin", point_json(vertices.origin)},
          {"step", vertices.step},
          {"total", mesh.triangles.size()},
          {"vertices", packed_array<std::uint16_t>(vertices.values, 3, PackedRows::differences)},
          {"triangles", packed_array<std::uint32_t>(triangles, 3, PackedRows::differences)}};
}

Json cloud_json(const PointCloud& cloud, const std::vector<std::uint16_t>& scan_of_point, std::size_t max_points) {
  if (cloud.size() == 0) return nullptr;
  require(max_points > 0, "report cloud: max_points = 0, must be positive");
  require(cloud.normals.size() == cloud.size(), "report cloud: ", cloud.size(), " points have ", cloud.normals.size(),
          " normals");
  require(scan_of_point.empty() || scan_of_point.size() == cloud.size(), "report cloud: ", cloud.size(),
          " points have ", scan_of_point.size(), " scans");
  const std::size_t stride = (cloud.size() + max_points - 1) / max_points;
  std::vector<Vec3> points;
  std::vector<std::int8_t> normals;
  std::vector<std::uint16_t> scans;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    points.push_back(cloud.points[i]);
    for (int axis = 0; axis < 3; ++axis) {
      normals.push_back(static_cast<std::int8_t>(std::lround(std::clamp(cloud.normals[i][axis], -1.0, 1.0) * 127)));
    }
    if (!scan_of_point.empty()) scans.push_back(scan_of_point[i]);
  }
  const QuantisedPoints positions = quantised(points);
  return {{"origin", point_json(positions.origin)},
          {"step", positions.step},
          {"total", cloud.size()},
          {"points", packed_array<std::uint16_t>(positions.values, 3, PackedRows::differences)},
          {"normals", packed_array<std::int8_t>(normals, 3, PackedRows::differences)},
          {"scan_of_point",
           scans.empty() ? Json(nullptr) : packed_array<std::uint16_t>(scans, 1, PackedRows::differences)}};
}

}  // namespace vantage
