#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// The pixels of a ray grid that a voxel already covers, one bit each, in tiles of 8 x 8 pixels: row r of a tile is its
/// byte r, column c the bit c of that byte. Pixels outside of the frame count as covered from the start, and a border
/// of such tiles surrounds the frame, so that footprints need no clipping.
class Coverage {
 public:
  static constexpr int border = 2;  // tiles

  void reset(Resolution resolution);

  /// Words from one row of tiles to the next.
  [[nodiscard]] int stride() const { return stride_; }
  /// The tile of pixel (0, 0); tile (row, column) lies at [row * stride() + column].
  [[nodiscard]] std::uint64_t* first_tile() { return tiles_.data() + border * stride_ + border; }

  /// Covers the open pixels `first`..`last` of a row. Pixels outside of `first_sure`..`last_sure` are covered only
  /// where `hits(column)` says so. Returns whether any pixel was covered.
  template <class Hits>
  bool cover_row(int row, int first, int last, int first_sure, int last_sure, const Hits& hits) {
    bool any = false;
    std::uint64_t* tiles = first_tile() + static_cast<std::ptrdiff_t>(row >> 3) * stride_;
    const int shift = 8 * (row & 7);
    for (int tile = first >> 3; tile <= last >> 3; ++tile) {
      const unsigned open = bits(first - 8 * tile, last - 8 * tile) & ~static_cast<unsigned>(tiles[tile] >> shift);
      if (open == 0) continue;
      unsigned covered = open & bits(first_sure - 8 * tile, last_sure - 8 * tile);
      for (unsigned doubtful = open & ~covered; doubtful != 0; doubtful &= doubtful - 1) {
        const int column = std::countr_zero(doubtful);
        if (hits(8 * tile + column)) covered |= 1U << column;
      }
      tiles[tile] |= static_cast<std::uint64_t>(covered) << shift;
      any |= covered != 0;
    }
    return any;
  }

 private:
  /// Bits first..last of a byte; either end may lie outside, and nothing is set where first > last.
  [[nodiscard]] static unsigned bits(int first, int last) {
    const int from = first < 0 ? 0 : first;
    const int to = last > 7 ? 7 : last;
    return from > to ? 0U : (0xffU << from) & (0xffU >> (7 - to));
  }

  std::vector<std::uint64_t> tiles_;
  int stride_ = 0;
};

}  // namespace vantage
