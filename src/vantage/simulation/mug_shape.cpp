#include <algorithm>
#include <cmath>

#include "vantage/simulation/object_shapes.hpp"
#include "vantage/simulation/surface_builder.hpp"

namespace vantage {
namespace {

// Lengths in units of 0.1 m.
constexpr double height = 0.97;
constexpr double base_radius = 0.43;
constexpr double belly = 0.1;  // how far the wall swells beyond the base and the rim
constexpr double wall = 0.045;
constexpr double foot = 0.05;  // radius of the rounding between base and wall
constexpr double floor_height = 0.07;

constexpr int body_segments = 96;  // around the body
constexpr int wall_rings = 48;     // along the outer wall
constexpr int handle_rings = 72;

// Where the handle grows out of the wall: blocks of the wall's quads around angle 0.
constexpr int block_half_width = 4;  // segments
constexpr int block_height = 8;      // rings
constexpr int lower_block = 6;       // first ring
constexpr int upper_block = wall_rings - 6 - block_height;

double outer_radius(double z) { return base_radius + belly * std::sin(std::numbers::pi * (0.12 + 0.7 * z / height)); }

/// Height of a wall ring; rings between the whole ones are meant too.
double wall_height(double ring) { return foot + (height - wall / 2 - foot) * ring / wall_rings; }

/// Moves the corners of a block's border inwards, so that the border becomes an oval, and its surroundings by less and
/// less. Places are counted from the block's middle in half its sides.
Eigen::Vector2d rounded(const Eigen::Vector2d& place) {
  const double square_radius = place.cwiseAbs().maxCoeff();  // 1 on the border
  if (square_radius == 0 || square_radius >= 2) return place;
  const double share = std::min(1.0, 2 - square_radius);
  const double round_scale = square_radius / place.norm();
  return place * (1 - share + share * round_scale);
}

/// A vertex of the outer wall. Around angle 0 the grid of rings and columns gives way to the ends of the handle.
Vec3 wall_point(int ring, int column) {
  const int signed_column = column < body_segments / 2 ? column : column - body_segments;
  double moved_ring = ring;
  double moved_column = signed_column;
  for (const int block : {lower_block, upper_block}) {
    const double middle = block + 0.5 * block_height;
    const Eigen::Vector2d place(static_cast<double>(signed_column) / block_half_width,
                                (ring - middle) / (0.5 * block_height));
    const Eigen::Vector2d moved = rounded(place);
    if (moved == place) continue;
    moved_column = moved.x() * block_half_width;
    moved_ring = middle + moved.y() * 0.5 * block_height;
  }
  const double angle = 2 * std::numbers::pi * moved_column / body_segments;
  const double z = wall_height(moved_ring);
  return {outer_radius(z) * std::cos(angle), outer_radius(z) * std::sin(angle), z};
}

/// From the top of the outer wall over the rim and down the inside to the middle of the floor.
std::vector<OutlinePoint> inside(const OutlinePoint& top) {
  std::vector<OutlinePoint> points = arc(top - OutlinePoint(wall / 2, 0), wall / 2, 0, std::numbers::pi, 8);
  points.erase(points.begin());  // the top itself
  constexpr double fillet = 0.08;
  constexpr int rings = 40;
  const double bottom = floor_height + fillet;
  for (int i = 1; i < rings; ++i) {
    const double z = top.y() + (bottom - top.y()) * i / rings;
    points.emplace_back(outer_radius(z) - wall, z);
  }
  const OutlinePoint center(outer_radius(bottom) - wall - fillet, bottom);
  const auto rounding = arc(center, fillet, 0, -std::numbers::pi / 2, 8);
  points.insert(points.end(), rounding.begin(), rounding.end());
  points.emplace_back(0.5 * center.x(), floor_height);
  return points;
}

/// The border of the block of wall quads above wall ring `first`: counter-clockwise seen from outside, from its lower
/// left corner.
Ring block_border(const std::vector<Ring>& rings, int first) {
  const auto vertex = [&](int ring, int column) {
    return rings[static_cast<std::size_t>(ring)][static_cast<std::size_t>((column + body_segments) % body_segments)];
  };
  const int last = first + block_height;
  constexpr int w = block_half_width;
  Ring border;
  for (int column = -w; column < w; ++column) border.push_back(vertex(first, column));
  for (int ring = first; ring < last; ++ring) border.push_back(vertex(ring, w));
  for (int column = w; column > -w; --column) border.push_back(vertex(last, column));
  for (int ring = last; ring > first; --ring) border.push_back(vertex(ring, -w));
  return border;
}

/// The same border as the handle meets it after its half turn: upside down, from the upper left corner.
Ring turned_over(const Ring& border) {
  // Mirrored up-down, the run along the bottom becomes that along the top, taken backwards, and so on around.
  constexpr std::size_t first_corner = 4 * block_half_width + block_height;
  Ring turned;
  for (std::size_t k = 0; k < border.size(); ++k) {
    turned.push_back(border[(first_corner + border.size() - k) % border.size()]);
  }
  return turned;
}

bool in_block(int band, int column) {
  const bool in_columns = column < block_half_width || column >= body_segments - block_half_width;
  const auto in_rings = [&](int first) { return band >= first && band < first + block_height; };
  return in_columns && (in_rings(lower_block) || in_rings(upper_block));
}

/// A cross-section of the handle, whose middle line is part of a superellipse in the x-z plane.
struct HandlePath {
  Vec3 top, bottom;  // where it leaves the wall and where it comes back

  [[nodiscard]] Vec3 at(double s) const {
    constexpr double reach = 0.305;
    constexpr double exponent = 2 / 2.6;
    const auto power = [](double value) { return std::copysign(std::pow(std::abs(value), exponent), value); };
    const double up = power(std::cos(std::numbers::pi * s));
    const double out = power(std::sin(std::numbers::pi * s));
    return 0.5 * ((1 + up) * top + (1 - up) * bottom) + Vec3(reach * out, 0, 0);
  }
  /// Unit vector away from the mug's middle, in the plane of the handle.
  [[nodiscard]] Vec3 outwards(double s) const {
    constexpr double step = 1e-3;
    const Vec3 along = (at(s + step) - at(s - step)).normalized();
    return along.cross(Vec3::UnitY());
  }
};

void add_handle(SurfaceBuilder& surface, const Ring& start, const Ring& end) {
  const auto middle = [&](const Ring& border) {
    Vec3 sum = Vec3::Zero();
    for (const int vertex : border) sum += surface.point(vertex);
    return Vec3(sum / static_cast<double>(border.size()));
  };
  const HandlePath path{middle(start), middle(end)};
  constexpr double half_width = 0.085;
  constexpr double half_thickness = 0.05;
  constexpr double blend = 0.12;  // share of the path over which the wall's block turns into the oval
  Ring last = start;
  for (int i = 1; i < handle_rings; ++i) {
    const double s = static_cast<double>(i) / handle_rings;
    const double from_end = std::min(s, 1 - s) / blend;
    const double x = std::clamp(from_end, 0.0, 1.0);
    const double ovalness = x * x * (3 - 2 * x);
    std::vector<Vec3> section;
    for (std::size_t k = 0; k < start.size(); ++k) {
      // Seen along the handle, every vertex keeps its direction from the middle line, so that the tube does not twist.
      const Vec3 from_top = surface.point(start[k]) - path.top;
      const Vec3 from_bottom = surface.point(end[k]) - path.bottom;
      const double sideways = (1 - s) * from_top.y() + s * from_bottom.y();
      const double outwards = (1 - s) * from_top.z() - s * from_bottom.z();
      const Eigen::Vector2d direction = Eigen::Vector2d(sideways / half_width, outwards / half_thickness).normalized();
      const Vec3 on_oval =
          path.at(s) + half_width * direction.x() * Vec3::UnitY() + half_thickness * direction.y() * path.outwards(s);
      const Vec3& on_wall = surface.point(s < 0.5 ? start[k] : end[k]);
      section.emplace_back((1 - ovalness) * on_wall + ovalness * on_oval);
    }
    Ring next = surface.add_ring(section);
    surface.join(last, next);
    last = std::move(next);
  }
  surface.join(last, end);
}

}  // namespace

// The body is a solid of revolution. The handle replaces two blocks of the outer wall's quads: its first and last rings
// are the borders of these holes, so that the mug is one closed surface without hidden parts.
TriangleMesh mug_shape() {
  SurfaceBuilder surface;
  std::vector<OutlinePoint> base{{base_radius - 0.14, 0.04}, {base_radius - 0.11, 0}};
  const double wall_start = outer_radius(foot);
  const auto rounding = arc({wall_start - foot, foot}, foot, -std::numbers::pi / 2, 0, 8);
  base.insert(base.end(), rounding.begin(), rounding.end() - 1);  // the wall starts with the last point

  Ring last = surface.add_circle(base.front(), body_segments);
  surface.close_start({0, 0, base.front().y()}, last);
  const auto go_on = [&](const OutlinePoint& point) {
    Ring next = surface.add_circle(point, body_segments);
    surface.join(last, next);
    last = std::move(next);
  };
  for (std::size_t i = 1; i < base.size(); ++i) go_on(base[i]);

  std::vector<Ring> rings;
  for (int ring = 0; ring <= wall_rings; ++ring) {
    std::vector<Vec3> points;
    for (int column = 0; column < body_segments; ++column) points.push_back(wall_point(ring, column));
    rings.push_back(surface.add_ring(points));
  }
  surface.join(last, rings.front());
  for (int band = 0; band < wall_rings; ++band) {
    for (int column = 0; column < body_segments; ++column) {
      if (in_block(band, column)) continue;
      surface.join_segment(rings[static_cast<std::size_t>(band)], rings[static_cast<std::size_t>(band) + 1],
                           static_cast<std::size_t>(column));
    }
  }
  add_handle(surface, block_border(rings, upper_block), turned_over(block_border(rings, lower_block)));

  last = rings.back();
  const double top = wall_height(wall_rings);
  for (const OutlinePoint& point : inside({outer_radius(top), top})) go_on(point);
  surface.close_end(last, {0, 0, floor_height});
  return std::move(surface).take();
}

}  // namespace vantage
