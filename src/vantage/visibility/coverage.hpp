#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// The pixels of a ray grid that a voxel already covers, one bit each, in strips eight columns wide: a strip has one
/// byte per row, with column c as bit c. Eight rows of a strip, from any row on, are thus one word. Pixels outside of
/// the frame count as covered from the start, and a border of such pixels surrounds the frame, so that footprints need
/// no clipping.
class Coverage {
 public:
  static constexpr int border_strips = 2;
  static constexpr int border_rows = 16;
  static_assert(std::endian::native == std::endian::little, "row r of a word is taken to be its r-th byte in memory");

  void reset(Resolution resolution);

  /// Bytes from one strip to the next.
  [[nodiscard]] int stride() const { return stride_; }
  /// The byte of pixel (0, 0).
  [[nodiscard]] std::uint8_t* first_strip() { return strips_.data() + border_strips * stride_ + border_rows; }

  /// Covers the open pixels `first`..`last` of a row. Pixels outside of `first_sure`..`last_sure` are covered only
  /// where `hits(column)` says so. Returns whether any pixel was covered.
  template <class Hits>
  bool cover_row(int row, int first, int last, int first_sure, int last_sure, const Hits& hits) {
    bool any = false;
    for (int strip = first >> 3; strip <= last >> 3; ++strip) {
      const unsigned covered = hit_in(strip, row, first, last, first_sure, last_sure, hits);
      std::uint8_t& pixels = at(strip, row);
      pixels = static_cast<std::uint8_t>(pixels | covered);
      any |= covered != 0;
    }
    return any;
  }
  /// The same for a voxel that rays may pass once: the open pixels that it meets are covered here where `passed` has
  /// them already, and are covered in `passed` otherwise. Returns whether any open pixel was met.
  template <class Hits>
  bool pass_row(Coverage& passed, int row, int first, int last, int first_sure, int last_sure, const Hits& hits) {
    bool any = false;
    for (int strip = first >> 3; strip <= last >> 3; ++strip) {
      const unsigned met = hit_in(strip, row, first, last, first_sure, last_sure, hits);
      std::uint8_t& ended = at(strip, row);
      std::uint8_t& before = passed.at(strip, row);
      ended = static_cast<std::uint8_t>(ended | (met & before));
      before = static_cast<std::uint8_t>(before | met);
      any |= met != 0;
    }
    return any;
  }

 private:
  [[nodiscard]] std::uint8_t& at(int strip, int row) {
    return first_strip()[static_cast<std::ptrdiff_t>(strip) * stride_ + row];
  }
  /// The open pixels of a strip's row that a voxel meets, see cover_row().
  template <class Hits>
  [[nodiscard]] unsigned hit_in(int strip, int row, int first, int last, int first_sure, int last_sure,
                                const Hits& hits) {
    const unsigned open = bits(first - 8 * strip, last - 8 * strip) & ~static_cast<unsigned>(at(strip, row));
    unsigned covered = open & bits(first_sure - 8 * strip, last_sure - 8 * strip);
    for (unsigned doubtful = open & ~covered; doubtful != 0; doubtful &= doubtful - 1) {
      const int column = std::countr_zero(doubtful);
      if (hits(8 * strip + column)) covered |= 1U << column;
    }
    return covered;
  }
  /// Bits first..last of a byte; either end may lie outside, and nothing is set where first > last.
  [[nodiscard]] static unsigned bits(int first, int last) {
    const int from = first < 0 ? 0 : first;
    const int to = last > 7 ? 7 : last;
    return from > to ? 0U : (0xffU << from) & (0xffU >> (7 - to));
  }

  std::vector<std::uint8_t> strips_;
  int stride_ = 0;
};

}  // namespace vantage
