#include <array>
#include <map>
#include <utility>

#include "vantage/simulation/object_shapes.hpp"

namespace vantage {
namespace {

/// Splits every triangle in four and pushes the new vertices onto the unit sphere.
TriangleMesh split(const TriangleMesh& mesh) {
  TriangleMesh finer{mesh.vertices, {}};
  std::map<std::pair<int, int>, int> middle_of_edge;
  const auto middle = [&](int a, int b) {
    const auto [entry, is_new] = middle_of_edge.try_emplace(std::minmax(a, b), static_cast<int>(finer.vertices.size()));
    if (is_new) {
      const Vec3 sum = mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)];
      finer.vertices.push_back(sum.normalized());
    }
    return entry->second;
  };
  for (const Index3& t : mesh.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    finer.triangles.insert(finer.triangles.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace

// An octahedron keeps the six points on the axes, so that the bounding box is that of the true sphere.
TriangleMesh sphere_shape() {
  TriangleMesh sphere{{Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()},
                      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  constexpr int levels = 6;  // 32,768 triangles: 0.1 mm from the true sphere at a radius of 0.4 m
  for (int level = 0; level < levels; ++level) sphere = split(sphere);
  return sphere;
}

}  // namespace vantage
