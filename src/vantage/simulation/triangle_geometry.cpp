#include "vantage/simulation/triangle_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Positive where the ray passes the edge p-q on its left, seen along the ray. Swapping p and q changes the sign and
/// nothing else: both products of each component are the same numbers, and the sum runs in the same order.
double edge_side(const Vec3& p, const Vec3& q, const Vec3& direction) { return direction.dot(q.cross(p)); }

}  // namespace

std::optional<TriangleHit> meet(const TriangleCorners& triangle, const Vec3& origin, const Vec3& direction) {
  const Vec3 a = triangle.a - origin;
  const Vec3 b = triangle.b - origin;
  const Vec3 c = triangle.c - origin;
  const double at_a = edge_side(b, c, direction);
  const double at_b = edge_side(c, a, direction);
  const double at_c = edge_side(a, b, direction);
  const auto [low, high] = std::minmax({at_a, at_b, at_c});
  if (low < 0 && high > 0) return std::nullopt;
  const Vec3 normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
  const double slope = normal.dot(direction);
  if (slope == 0) return std::nullopt;  // seen edge-on; the neighbours close the surface
  const double t = normal.dot(a) / slope;
  if (!(t > 0)) return std::nullopt;
  return TriangleHit{t, low > 0 && slope < 0};
}

// C. Ericson, Real-Time Collision Detection (2005), section 5.1.5: which of the seven regions around the triangle.
Vec3 closest_point(const TriangleCorners& triangle, const Vec3& point) {
  const auto& [a, b, c] = triangle;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

}  // namespace vantage
