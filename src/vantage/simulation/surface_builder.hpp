#pragma once

#include <span>
#include <vector>

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// Vertex numbers of a closed ring. Rings follow each other along a surface, and each runs counter-clockwise seen from
/// the next one.
using Ring = std::vector<int>;

/// A point (radius, height) of the outline of a solid of revolution about z.
using OutlinePoint = Eigen::Vector2d;

/// Builds closed surfaces from rings of vertices. All triangles face outwards.
class SurfaceBuilder {
 public:
  int add_vertex(const Vec3& point);
  [[nodiscard]] Ring add_ring(std::span<const Vec3> points);
  /// A ring about the z axis that starts at x = radius, y = 0.
  [[nodiscard]] Ring add_circle(const OutlinePoint& radius_and_height, int segments);

  /// The first ring of a surface, closed by a fan from a new vertex.
  void close_start(const Vec3& apex, const Ring& first);
  /// A band between two rings of equal size; vertex k joins vertex k.
  void join(const Ring& from, const Ring& to);
  /// The part of that band between vertex k and its successor.
  void join_segment(const Ring& from, const Ring& to, std::size_t k);
  void close_end(const Ring& last, const Vec3& apex);

  [[nodiscard]] const Vec3& point(int vertex) const { return mesh_.vertices[static_cast<std::size_t>(vertex)]; }
  /// The finished surface; vertices that no triangle uses are left out.
  [[nodiscard]] TriangleMesh take() &&;

 private:
  TriangleMesh mesh_;
};

/// The closed surface that an outline sweeps about the z axis. The outline starts and ends on the axis (radius 0) and
/// has the solid on its left.
[[nodiscard]] TriangleMesh solid_of_revolution(std::span<const OutlinePoint> outline, int segments);

/// Points of a circular arc about `center` from angle `from` to angle `to` (radians), both ends included.
[[nodiscard]] std::vector<OutlinePoint> arc(const OutlinePoint& center, double radius, double from, double to,
                                            int steps);

/// A smooth curve through points (Catmull-Rom), each gap between neighbours cut into `steps`. The ends are included.
[[nodiscard]] std::vector<OutlinePoint> smooth_curve(std::span<const OutlinePoint> points, int steps);

}  // namespace vantage
