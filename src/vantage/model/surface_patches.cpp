#include "vantage/model/surface_patches.hpp"

namespace vantage {
namespace {

constexpr std::size_t edge_between(std::size_t a, std::size_t b) {
  for (std::size_t edge = 0; edge < 12; ++edge) {
    const CubeEdge ends = cube_edge(edge);
    if ((ends.from == a && ends.to == b) || (ends.from == b && ends.to == a)) return edge;
  }
  return 12;
}

/// Edges that belong together, as a forest.
struct EdgeSets {
  std::array<std::size_t, 12> parent{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

  [[nodiscard]] constexpr std::size_t root(std::size_t edge) const {
    while (parent[edge] != edge) edge = parent[edge];
    return edge;
  }
  constexpr void join(std::size_t a, std::size_t b) { parent[root(a)] = root(b); }
};

/// Joins the crossed edges of one face in pairs.
constexpr void join_on_face(std::size_t inside, std::size_t axis, std::size_t far, EdgeSets& sets) {
  const std::size_t right = std::size_t{1} << ((axis + 1) % 3), up = std::size_t{1} << ((axis + 2) % 3);
  const std::size_t base = far << axis;
  const std::array<std::size_t, 4> corners{base, base | right, base | right | up, base | up};
  const auto is_inside = [&](std::size_t k) { return ((inside >> corners[k % 4]) & 1U) != 0; };
  const auto edge = [&](std::size_t k) { return edge_between(corners[k % 4], corners[(k + 1) % 4]); };
  std::array<std::size_t, 4> crossed{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (is_inside(k) != is_inside(k + 1)) crossed[count++] = k;
  }
  if (count == 2) sets.join(edge(crossed[0]), edge(crossed[1]));
  if (count != 4) return;
  for (std::size_t k = 0; k < 4; ++k) {  // around each inside corner: the edges before and after it
    if (is_inside(k)) sets.join(edge(k + 3), edge(k));
  }
}

constexpr CubePatches make_cube_patches() {
  CubePatches patches;
  for (std::size_t inside = 0; inside < 256; ++inside) {
    EdgeSets sets;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      join_on_face(inside, axis, 0, sets);
      join_on_face(inside, axis, 1, sets);
    }
    std::array<std::int8_t, 12> number_of_root{};
    number_of_root.fill(-1);
    for (std::size_t edge = 0; edge < 12; ++edge) {
      const CubeEdge ends = cube_edge(edge);
      const bool crossed = ((inside >> ends.from) & 1U) != ((inside >> ends.to) & 1U);
      patches.patch_of_edge[inside][edge] = -1;
      if (!crossed) continue;
      std::int8_t& number = number_of_root[sets.root(edge)];
      if (number < 0) number = static_cast<std::int8_t>(patches.count[inside]++);
      patches.patch_of_edge[inside][edge] = number;
    }
  }
  return patches;
}

}  // namespace

const CubePatches& cube_patches() {
  static constexpr CubePatches patches = make_cube_patches();
  return patches;
}

}  // namespace vantage
