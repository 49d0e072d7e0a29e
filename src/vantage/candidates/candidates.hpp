#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/sensor/view.hpp"

namespace vantage {

/// Where candidates of a view cube sit: cell (x,y,z) of n^3, x fastest.
struct CandidateGrid {
  int cells_per_side = 0;
  Vec3 spacing = Vec3::Zero();       // metres between neighbouring cells, per axis
  std::vector<Index3> cell_of_view;  // one per view

  bool operator==(const CandidateGrid&) const = default;
};

/// The candidate views of a reconstruction. The index of a view is its identity: ties fall to the lowest.
struct Candidates {
  enum class Kind { sphere, grid, list };
  Kind kind = Kind::list;
  Vec3 center = Vec3::Zero();  // what they look at
  std::vector<View> views;
  std::optional<CandidateGrid> grid;  // for a view cube
};

/// View sphere (paper, section 4.1): the face centres of an icosahedron each of whose faces is split in four, as often
/// as `count` = 20*4^k asks for; all at `radius` metres from `center`, looking at it. Any other count throws
/// InputError.
[[nodiscard]] Candidates view_sphere(int count, double radius, const Vec3& center);

/// View cube (paper, section 4.1): the centres of n^3 cells of a box with edges `side` (metres), kept where the
/// distance to `center` lies within [inner_radius, outer_radius], looking at the center.
[[nodiscard]] Candidates view_cube(int n, const Vec3& side, double inner_radius, double outer_radius,
                                   const Vec3& center);

/// `sphere:N:R`, `cube:N:SIDE:INNER:OUTER` (SIDE one length or SX,SY,SZ). Throws InputError that names the bad part.
[[nodiscard]] Candidates candidates_from_text(const std::string& text, const Vec3& center);

}  // namespace vantage
