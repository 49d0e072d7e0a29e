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

/// splat_front() with the second layer.
template <class V>
std::size_t splat_front_sights(const BatchView& view, const GrazingLayer& layer, const BatchRegion& region,
                               const Queue<V>& queue, std::uint32_t* visible) {
  using Int = typename V::Int;
  const Window<V> window = queue.front();
  const Place<V> place = place_of<V>(view, V::load(queue.values[Queue<V>::voxel]));
  Borders<V> borders = borders_of<V>(view, region, place, window);
  const Int is_drawn = ~(window.special | borders.special);
  Stamp<V> stamp;
  const Int doubtful = draw<V>(view, borders, V::largest(window.rows & is_drawn), stamp);
  const unsigned special = V::lane_bits(~is_drawn | doubtful);
  const int used = static_cast<int>(queue.count < V::lanes ? queue.count : V::lanes);
  std::size_t seen = 0;
  for (int lane = 0; lane < used; ++lane) {
    const std::uint32_t voxel = queue.values[Queue<V>::voxel][lane];
    const auto at = static_cast<std::int32_t>(queue.values[Queue<V>::place][lane]);
    const auto rows = static_cast<std::int32_t>(queue.values[Queue<V>::rows][lane]);
    bool is_visible = false;
    if ((special >> lane & 1U) != 0) {
      is_visible = view.splat_one(view.context, voxel);
    } else if (is_grazing<V>(layer, voxel)) {
      is_visible = press_grazing<V>(view, layer, stamp, lane, at, rows);
    } else {
      is_visible = press<V>(view, stamp, lane, at, rows);
    }
    visible[seen] = voxel;
    seen += is_visible ? 1 : 0;
  }
  return seen;
}

/// splat_batches() with the second layer.
template <class V>
std::size_t splat_sights(const BatchView& view, const GrazingLayer& layer, const BatchRegion& region,
                         const std::uint32_t* voxels, std::size_t count, std::uint32_t* visible) {
  constexpr std::size_t lanes = V::lanes;
  Queue<V> queue;
  std::uint32_t last_batch[lanes] = {};
  std::size_t seen = 0;
  for (std::size_t begin = 0; begin < count; begin += lanes) {
    const std::size_t used = count - begin < lanes ? count - begin : lanes;
    const std::uint32_t* batch = voxels + begin;
    if (used < lanes) {
      __builtin_memcpy(last_batch, batch, used * sizeof *batch);
      batch = last_batch;
    }
    const typename V::Int packed = V::load(batch);
    const Window<V> window = window_of<V>(view, place_of<V>(view, packed));
    unsigned open = ~V::lane_bits(window.outside) & ((2U << (used - 1)) - 1);
    if (open != 0) open &= ~hidden_lanes<V>(view, window);
    if (open == 0) continue;
    queue.push(packed, window, open);
    if (queue.count < lanes) continue;
    seen += splat_front_sights<V>(view, layer, region, queue, visible + seen);
    queue.drop_front();
  }
  if (queue.count > 0) seen += splat_front_sights<V>(view, layer, region, queue, visible + seen);
  return seen;
}

}  // namespace vantage::simd
