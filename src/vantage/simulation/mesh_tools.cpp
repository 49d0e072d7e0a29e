#include "vantage/simulation/mesh_tools.hpp"

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double min_extent = 1e-6;
constexpr double max_extent = 1e6;

double largest_side_of(const TriangleMesh& mesh) { return mesh.box().sizes().maxCoeff(); }

double fraction(double value) { return value - std::floor(value); }

}  // namespace

void check_mesh(const TriangleMesh& mesh, const std::string& name) {
  require(!mesh.triangles.empty(), name, ": the mesh has ", mesh.vertices.size(),
          " vertices and no triangles; must have at least one triangle (a point cloud cannot be scanned)");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    require(mesh.vertices[i].allFinite(), name, ": vertex ", i, " = (", mesh.vertices[i].transpose(),
            "): must be finite numbers");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const int corner : mesh.triangles[i]) {
      require(corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size(), name, ": triangle ", i,
              " has the corner ", corner, "; must be 0 to ", static_cast<std::ptrdiff_t>(mesh.vertices.size()) - 1);
    }
  }
  const double extent = largest_side_of(mesh);
  require(extent > 0, name, ": the mesh has zero extent (all vertices are the same point)");
  require(extent >= min_extent && extent <= max_extent, name, ": the largest side of the mesh is ", extent,
          "; must be within ", min_extent, " and ", max_extent, " (is the unit right?)");
  const double area = surface_area(mesh);
  // Relative to the extent, so that the unit of the file plays no role.
  require(area > 1e-12 * extent * extent, name, ": the triangles have no area (all are degenerate)");
}

TriangleMesh centred_and_scaled(TriangleMesh mesh, double largest_side) {
  require(largest_side >= 1e-3 && largest_side <= 1e3, "size = ", largest_side,
          " m: must be within 0.001 m and 1000 m");
  const double extent = mesh.vertices.empty() ? 0 : largest_side_of(mesh);
  require(extent > 0, "size = ", largest_side, " m: a mesh of zero extent cannot be scaled");
  const Vec3 center = mesh.box().center();
  const double scale = largest_side / extent;
  for (Vec3& vertex : mesh.vertices) vertex = (vertex - center) * scale;
  return mesh;
}

Vec3 area_vector(const TriangleMesh& mesh, std::size_t triangle) {
  const Vec3 a = mesh.corner(triangle, 0);
  return (mesh.corner(triangle, 1) - a).cross(mesh.corner(triangle, 2) - a);
}

double surface_area(const TriangleMesh& mesh) {
  double twice = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) twice += area_vector(mesh, i).norm();
  return twice / 2;
}

double signed_volume(const TriangleMesh& mesh) {
  double six_times = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    six_times += mesh.corner(i, 0).dot(mesh.corner(i, 1).cross(mesh.corner(i, 2)));
  }
  return six_times / 6;
}

std::vector<MeshSample> sample_surface(const TriangleMesh& mesh, int count, Random& random) {
  require(count > 0, "surface samples = ", count, ": must be positive");
  const double area = surface_area(mesh);
  require(area > 0, "surface samples: the mesh has no area");
  // 1/g and 1/g^2 of the plastic number g, the root of g^3 = g + 1: M. Roberts, "The unreasonable effectiveness of
  // quasirandom sequences" (2018).
  constexpr double step_a = 0.7548776662466927;
  constexpr double step_b = 0.5698402909980532;
  const double start = random.uniform();
  const double start_a = random.uniform();
  const double start_b = random.uniform();
  std::vector<MeshSample> samples;
  samples.reserve(static_cast<std::size_t>(count));
  double area_so_far = 0;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const Vec3 cross = area_vector(mesh, triangle);
    const double length = cross.norm();
    if (!(length > 0)) continue;
    area_so_far += length / 2;
    const Vec3 normal = cross / length;
    const Vec3 a = mesh.corner(triangle, 0);
    const Vec3 ab = mesh.corner(triangle, 1) - a;
    const Vec3 ac = mesh.corner(triangle, 2) - a;
    const bool is_last = triangle + 1 == mesh.triangles.size();
    const double samples_until_here = is_last ? count : std::min<double>(count, area_so_far / area * count - start);
    while (static_cast<double>(samples.size()) < samples_until_here) {
      const auto i = static_cast<double>(samples.size());
      // Folding the unit square on its diagonal keeps the area and is cheaper than the square root.
      double u = fraction(start_a + i * step_a);
      double v = fraction(start_b + i * step_b);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      samples.push_back({a + u * ab + v * ac, normal, static_cast<int>(triangle)});
    }
  }
  // Degenerate triangles at the end of the list leave the last place to fill.
  while (samples.size() < static_cast<std::size_t>(count)) samples.push_back(samples.back());
  return samples;
}

}  // namespace vantage
