#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vantage {

/// Corner k of a cube lies at (k & 1, k >> 1 & 1, k >> 2 & 1).
/// Edge `4 axis + i + 2 j` runs along the axis; i and j say where it lies along the next axis and the one after.
struct CubeEdge {
  std::size_t from, to;  // corners, in the direction of the axis
};

[[nodiscard]] constexpr CubeEdge cube_edge(std::size_t edge) {
  const std::size_t axis = edge / 4;
  const std::size_t from = ((edge & 1U) << ((axis + 1) % 3)) | (((edge >> 1U) & 1U) << ((axis + 2) % 3));
  return {from, from | (std::size_t{1} << axis)};
}

/// The sheets in which a surface passes a cube, for each of the 256 cases in which corners can be inside (bit k: corner
/// k is inside): which sheet crosses which edge. On faces with inside corners across from each other the sheets keep
/// these apart, in both cubes alike, so that sheets always fit together (the dual of marching cubes, Nielson 2004).
struct CubePatches {
  std::array<std::array<std::int8_t, 12>, 256> patch_of_edge{};  // -1: not crossed
  std::array<std::uint8_t, 256> count{};
};

[[nodiscard]] const CubePatches& cube_patches();

}  // namespace vantage
