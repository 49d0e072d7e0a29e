#pragma once

#include "vantage/visibility/sight_batch.hpp"
#include "vantage/visibility/splat_kernel.hpp"

// Only templates on V here, see splat_batch.hpp.
namespace vantage::simd {

/// As press(), for a grazing voxel: it ends the rays that have passed one already and lets the others pass.
template <class V>
bool press_grazing(const BatchView& view, const GrazingLayer& layer, const Stamp<V>& stamp, int lane,
                   std::int32_t place, std::int32_t rows) {
  std::uint64_t any = 0;
  const auto press_word = [&](std::uint64_t pixels, std::ptrdiff_t at) {
    std::uint64_t ended, passed;
    __builtin_memcpy(&ended, view.strips + at, sizeof ended);
    __builtin_memcpy(&passed, layer.passed + at, sizeof passed);
    any |= pixels & ~ended;
    ended |= pixels & passed;
    passed |= pixels;
    __builtin_memcpy(view.strips + at, &ended, sizeof ended);
    __builtin_memcpy(layer.passed + at, &passed, sizeof passed);
  };
  press_word(stamp.left[0][lane], place);
  press_word(stamp.right[0][lane], place + view.stride);
  if (rows > 8) {
    press_word(stamp.left[1][lane], place + 8);
    press_word(stamp.right[1][lane], place + view.stride + 8);
  }
  return any != 0;
}

template <class V>
bool is_grazing(const GrazingLayer& layer, std::uint32_t voxel) {
  if (voxel >> 30U != 1) return false;  // not occupied
  const std::size_t x = voxel & 1023U;
  const std::size_t row = (voxel >> 20U & 1023U) * layer.rows_per_layer + (voxel >> 10U & 1023U);
  return (layer.grazing[row * layer.words_per_row + (x >> 6U)] >> (x & 63U) & 1U) != 0;
}

template <class V>
struct PressSights {
  const BatchView& view;
  const GrazingLayer& layer;
  bool operator()(const Stamp<V>& stamp, int lane, std::uint32_t voxel, std::int32_t place, std::int32_t rows) const {
    return is_grazing<V>(layer, voxel) ? press_grazing<V>(view, layer, stamp, lane, place, rows)
                                       : press<V>(view, stamp, lane, place, rows);
  }
};

/// splat_batches() with the second layer.
template <class V>
std::size_t splat_sights(const BatchView& view, const GrazingLayer& layer, const BatchRegion& region,
                         const std::uint32_t* voxels, std::size_t count, std::uint32_t* visible) {
  return splat_all<V>(view, region, voxels, count, PressSights<V>{view, layer}, visible);
}

}  // namespace vantage::simd
