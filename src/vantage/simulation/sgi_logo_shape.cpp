#include <array>
#include <cmath>

#include "vantage/simulation/object_shapes.hpp"
#include "vantage/simulation/surface_builder.hpp"

namespace vantage {
namespace {

// Lengths in units of half the cube that the middle line of the tubes keeps to.
constexpr double inner = 0.56;  // where the tube runs inside a face instead of along the cube's edge
constexpr double tube_radius = 0.199;
constexpr double bend_radius = 1.05 * tube_radius;
constexpr int tube_segments = 32;  // around the tube; a multiple of 4, so that quarter turns of the section fit
constexpr int bend_steps = 10;
constexpr int straight_steps = 8;

/// The closed middle line: each half is the other one mirrored in the centre.
std::vector<Vec3> corners() {
  constexpr double b = inner;
  std::vector<Vec3> line{{-1, -1, -b}, {b, -1, -b}, {b, -1, 1},  {-b, -1, 1}, {-b, b, 1},
                         {1, b, 1},    {1, -b, 1},  {1, -b, -b}, {1, 1, -b}};
  const std::size_t half = line.size();
  for (std::size_t i = 0; i < half; ++i) line.push_back(-line[i]);
  return line;
}

/// A place on the middle line with two directions across it; across x beside = along the line.
struct Section {
  Vec3 middle, across, beside;
};

/// Sections along the whole line, carried along without twist: only bends turn them. The last one is at the place of
/// the first, turned by some quarters.
std::vector<Section> sections() {
  const std::vector<Vec3> line = corners();
  const std::size_t count = line.size();
  const auto direction = [&](std::size_t i) { return Vec3((line[(i + 1) % count] - line[i % count]).normalized()); };
  const Vec3 first = direction(0);
  Vec3 across = first.unitOrthogonal();
  Vec3 beside = first.cross(across);
  std::vector<Section> result;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 before = direction(i);
    const Vec3 after = direction(i + 1);
    const Vec3 start = line[i] + bend_radius * before;
    const Vec3 end = line[(i + 1) % count] - bend_radius * before;
    for (int k = 0; k < straight_steps; ++k) {
      result.push_back({start + (end - start) * k / straight_steps, across, beside});
    }
    const Vec3 axis = before.cross(after);
    const Vec3 center = end + bend_radius * after;
    for (int k = 0; k < bend_steps; ++k) {
      const Mat3 turn = Eigen::AngleAxisd(std::numbers::pi / 2 * k / bend_steps, axis).toRotationMatrix();
      result.push_back({center + turn * (end - center), turn * across, turn * beside});
    }
    const Mat3 quarter_turn = Eigen::AngleAxisd(std::numbers::pi / 2, axis).toRotationMatrix();
    across = quarter_turn * across;
    beside = quarter_turn * beside;
  }
  result.push_back({result.front().middle, across, beside});
  return result;
}

/// Turns the cube's diagonal (-1, 1, 1) up, and about it to where the bounding box is smallest.
Mat3 on_a_corner() {
  const auto upright = Eigen::Quaterniond::FromTwoVectors(Vec3(-1, 1, 1).normalized(), Vec3::UnitZ());
  return (Eigen::AngleAxisd(std::numbers::pi / 12, Vec3::UnitZ()) * upright).toRotationMatrix();
}

}  // namespace

TriangleMesh sgi_logo_shape() {
  SurfaceBuilder surface;
  const Mat3 rotation = on_a_corner();
  const std::vector<Section> all = sections();
  std::vector<Ring> rings;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < tube_segments; ++k) {
      const double angle = 2 * std::numbers::pi * k / tube_segments;
      const Vec3 offset = tube_radius * (std::cos(angle) * all[i].across + std::sin(angle) * all[i].beside);
      points.emplace_back(rotation * (all[i].middle + offset));
    }
    rings.push_back(surface.add_ring(points));
  }
  for (std::size_t i = 1; i < rings.size(); ++i) surface.join(rings[i - 1], rings[i]);
  // The loop closes with the vertices that face each other after the turns.
  const Vec3& across = all.back().across;
  const double turned = std::atan2(across.dot(all.front().beside), across.dot(all.front().across));
  const auto shift = static_cast<int>(std::lround(turned / (2 * std::numbers::pi) * tube_segments)) + tube_segments;
  Ring end;
  for (int k = 0; k < tube_segments; ++k)
    end.push_back(rings.front()[static_cast<std::size_t>((k + shift) % tube_segments)]);
  surface.join(rings.back(), end);
  return std::move(surface).take();
}

}  // namespace vantage
