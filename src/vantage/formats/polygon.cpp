#include "vantage/formats/polygon.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr std::size_t most_concave_corners = 100;  // cutting ears takes the third power of it

/// Twice the signed area of the triangle; positive where it turns left.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corners in the plane that fits the polygon best, where it turns left.
std::vector<Vec2> flattened(const TriangleMesh& mesh, std::span<const int> corners) {
  const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(corners[i])]; };
  Vec3 normal = Vec3::Zero();  // twice the area vector (Newell)
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
  if (!(normal.norm() > 0)) return std::vector<Vec2>(corners.size(), Vec2::Zero());
  normal.normalize();
  const Vec3 x = normal.unitOrthogonal();
  const Vec3 y = normal.cross(x);
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < corners.size(); ++i) points.emplace_back(x.dot(at(i) - at(0)), y.dot(at(i) - at(0)));
  return points;
}

bool is_convex(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) return false;
  }
  return true;
}

struct Corner {
  int vertex;
  Vec2 point;
};

bool is_ear(const std::vector<Corner>& corners, std::size_t i) {
  const std::size_t n = corners.size();
  const std::size_t before = (i + n - 1) % n;
  const std::size_t after = (i + 1) % n;
  const Vec2 &a = corners[before].point, &b = corners[i].point, &c = corners[after].point;
  if (!(turn(a, b, c) > 0)) return false;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == before || k == i || k == after) continue;
    const Vec2& p = corners[k].point;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

void cut_ears(TriangleMesh& mesh, std::vector<Corner> corners) {
  while (corners.size() > 3) {
    std::size_t ear = 0;
    while (ear < corners.size() && !is_ear(corners, ear)) ++ear;
    if (ear == corners.size()) ear = 0;  // a polygon that crosses itself has no ears; any triangle is as good
    const std::size_t n = corners.size();
    mesh.triangles.emplace_back(corners[(ear + n - 1) % n].vertex, corners[ear].vertex, corners[(ear + 1) % n].vertex);
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  mesh.triangles.emplace_back(corners[0].vertex, corners[1].vertex, corners[2].vertex);
}

}  // namespace

void append_polygon(TriangleMesh& mesh, std::span<const int> corners, const std::string& name, std::size_t face) {
  if (corners.size() == 3) {  // nearly all polygons of nearly all meshes
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
      mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
    }
    return;
  }
  std::vector<int> kept(corners.begin(), corners.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  while (kept.size() > 1 && kept.front() == kept.back()) kept.pop_back();
  if (kept.size() < 3) return;
  const std::vector<Vec2> points = flattened(mesh, kept);
  if (is_convex(points)) {
    for (std::size_t i = 1; i + 1 < kept.size(); ++i) mesh.triangles.emplace_back(kept[0], kept[i], kept[i + 1]);
    return;
  }
  require(kept.size() <= most_concave_corners, name, ": face ", face, " is not convex and has ", kept.size(),
          " corners; must be at most ", most_concave_corners, ", or triangles");
  std::vector<Corner> ring;
  for (std::size_t i = 0; i < kept.size(); ++i) ring.push_back({kept[i], points[i]});
  cut_ears(mesh, std::move(ring));
}

}  // namespace vantage
