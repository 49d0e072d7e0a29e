#pragma once

#include "vantage/visibility/silhouette_kernel.hpp"

// What happens to silhouettes on the pixels: hidden ones are dropped, the others drawn and pressed into the coverage,
// front to back. Only templates on V here, see splat_batch.hpp.
namespace vantage::simd {

/// 16 x 16 pixels per lane: eight rows of eight pixels per word, in the columns 0..7 (left) and 8..15 (right). Row r is
/// byte r of its word, as in Coverage.
template <class V>
struct Stamp {
  alignas(64) std::uint64_t left[2][V::lanes];
  alignas(64) std::uint64_t right[2][V::lanes];
};

constexpr float sub_pixels = 0x1p16F;  // columns are compared in fixed point
constexpr std::int32_t sub_pixel_bits = 16;

/// Rows `first`.. of 16 columns per lane (bits 0..15 of each of `rows`), as words of four rows of eight columns each.
template <class V>
struct FourRows {
  typename V::Int left, right;
};
template <class V>
FourRows<V> four_rows(typename V::Int even, typename V::Int odd) {
  const typename V::Int low_bytes = V::all(0x00ff00ff);
  return {(even & low_bytes) | (odd & low_bytes) << 8, ((even >> 8) & low_bytes) | (odd & ~low_bytes)};
}

/// The lanes in which the silhouette's bounds have no open pixel, so that the voxel is hidden for certain. Bounds of
/// more than eight rows are not looked at.
template <class V>
unsigned hidden_lanes(const BatchView& view, const Window<V>& window) {
  using Int = typename V::Int;
  const Int is_asked = ~(window.outside | window.special) & (window.rows <= 8);
  const Int row = V::ones_above(window.before & V::all(7)) &
                  ~V::ones_above((window.before + window.columns) & is_asked & V::all(31));
  const Int columns = (row & V::all(0xffff)) | row << 16;
  const FourRows<V> box = four_rows<V>(columns, columns);
  // The lowest `rows` bytes; all four of them cannot be had by a shift.
  const auto bytes_below = [](Int rows) {
    return ~V::ones_above(V::max(V::min(rows, V::all(3)), V::all(0)) << 3) | (rows >= 4);
  };
  const Int upper = bytes_below(window.rows);
  const Int lower = bytes_below(window.rows - 4);
  const Int place = window.place & is_asked;
  const auto is_open = [&](Int columns_of_strip, const std::uint8_t* strip) {
    return V::any_open(strip, place, columns_of_strip & upper, columns_of_strip & lower);
  };
  const unsigned open = is_open(box.left, view.strips) | is_open(box.right, view.strips + view.stride);
  return V::lane_bits(is_asked) & ~open;
}

/// Marks the pixels between the borders, row by row. Returns a mask of the lanes in which a border runs closer to a
/// pixel than its rounding, so that only the exact test can tell.
template <class V>
typename V::Int draw(const BatchView& view, Borders<V>& borders, std::int32_t rows, Stamp<V>& stamp) {
  using Float = typename V::Float;
  using Int = typename V::Int;
  const Float error =
      V::multiply_add(borders.steepness, V::all(view.column_error_of_steepness), V::all(view.column_error));
  const Float scale = V::all(sub_pixels);
  const Float shift = V::all(1.0F) + error;  // floor(x + 1) is the first pixel to the right of x
  for (int k = 0; k < 3; ++k) {
    borders.left[k] = (borders.left[k] + shift) * scale;
    borders.right[k] = (borders.right[k] + shift) * scale;
    borders.left_slope[k] *= scale;
    borders.right_slope[k] *= scale;
  }
  const Float lowest = V::all(0.5F * sub_pixels);
  const Float highest = V::all((window_side + 0.5F) * sub_pixels);
  const Int fraction = V::all((1 << sub_pixel_bits) - 1);
  Int closest = fraction;
  const auto row_bits = [&](std::int32_t row) {
    const Float r = V::all(static_cast<float>(row));
    Float left = V::multiply_add(borders.left_slope[0], r, borders.left[0]);
    Float right = V::multiply_add(borders.right_slope[0], r, borders.right[0]);
    for (int k = 1; k < 3; ++k) {
      left = V::max(left, V::multiply_add(borders.left_slope[k], r, borders.left[k]));
      right = V::min(right, V::multiply_add(borders.right_slope[k], r, borders.right[k]));
    }
    const Int from = V::truncate(V::min(V::max(left, lowest), highest));
    const Int to = V::truncate(V::min(V::max(right, lowest), highest));
    closest = V::min(closest, V::min(from & fraction, to & fraction));
    return V::ones_above(from >> sub_pixel_bits) & ~V::ones_above(to >> sub_pixel_bits);
  };
  const auto rows_from = [&](std::int32_t row) {
    Int even = row_bits(row);
    Int odd = row_bits(row + 1);
    if (row + 2 < rows) {
      even |= row_bits(row + 2) << 16;
      odd |= row_bits(row + 3) << 16;
    }
    return four_rows<V>(even, odd);
  };
  for (std::int32_t half = 0; 8 * half < rows; ++half) {
    const FourRows<V> upper = rows_from(8 * half);
    FourRows<V> lower{V::all(0), V::all(0)};
    if (8 * half + 4 < rows) lower = rows_from(8 * half + 4);
    V::store_words(stamp.left[half], upper.left, lower.left);
    V::store_words(stamp.right[half], upper.right, lower.right);
  }
  return (closest <= V::truncate(V::multiply_add(error, V::all(2 * sub_pixels), V::all(4.0F)))) |
         (error > V::all(0.1F));
}

/// Covers the open pixels of one lane's stamp, which has so many rows; whether there were any.
template <class V>
bool press(const BatchView& view, const Stamp<V>& stamp, int lane, std::int32_t place, std::int32_t rows) {
  std::uint64_t any = 0;
  const auto press_word = [&any](std::uint64_t pixels, std::uint8_t* at) {
    std::uint64_t covered;
    __builtin_memcpy(&covered, at, sizeof covered);
    any |= pixels & ~covered;
    covered |= pixels;
    __builtin_memcpy(at, &covered, sizeof covered);
  };
  std::uint8_t* const at = view.strips + place;
  press_word(stamp.left[0][lane], at);
  press_word(stamp.right[0][lane], at + view.stride);
  if (rows > 8) {
    press_word(stamp.left[1][lane], at + 8);
    press_word(stamp.right[1][lane], at + view.stride + 8);
  }
  return any != 0;
}

/// Voxels that are not hidden yet, until there are enough for all lanes.
template <class V>
struct Queue {
  enum Field { voxel, column, row, inverse_depth, place, rows, fields };  // rows: all bits set where special
  alignas(64) std::uint32_t values[fields][2 * V::lanes] = {};
  std::size_t count = 0;

  void push(typename V::Int voxels, const Window<V>& window, unsigned lanes) {
    const auto put = [&](Field field, typename V::Int x) { V::store_lanes(values[field] + count, x, lanes); };
    put(voxel, voxels);
    put(column, V::float_to_bits(window.column));
    put(row, V::float_to_bits(window.row));
    put(inverse_depth, V::float_to_bits(window.inverse_depth));
    put(place, window.place);
    put(rows, window.rows | window.special);
    count += static_cast<std::size_t>(__builtin_popcount(lanes));
  }
  [[nodiscard]] Window<V> front() const {
    Window<V> window;
    window.column = V::bits_to_float(V::load(values[column]));
    window.row = V::bits_to_float(V::load(values[row]));
    window.inverse_depth = V::bits_to_float(V::load(values[inverse_depth]));
    window.rows = V::load(values[rows]);
    window.special = window.rows < 0;
    return window;
  }
  void drop_front() {
    count -= V::lanes;
    for (int field = 0; field < fields; ++field) V::store(values[field], V::load(values[field] + V::lanes));
  }
};

/// Splats the first voxels of the queue, `visible` as in SplatBatch. `press_stamp(stamp, lane, voxel, place, rows)`
/// puts a stamp into the coverage and tells whether a pixel of it was free.
template <class V, class PressStamp>
std::size_t splat_front(const BatchView& view, const BatchRegion& region, const Queue<V>& queue,
                        const PressStamp& press_stamp, std::uint32_t* visible) {
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
    const bool is_visible =
        (special >> lane & 1U) != 0
            ? view.splat_one(view.context, voxel)
            : press_stamp(stamp, lane, voxel, static_cast<std::int32_t>(queue.values[Queue<V>::place][lane]),
                          static_cast<std::int32_t>(queue.values[Queue<V>::rows][lane]));
    visible[seen] = voxel;
    seen += is_visible ? 1 : 0;
  }
  return seen;
}

/// All voxels of a list, batch after batch, with `press_stamp` of splat_front().
template <class V, class PressStamp>
std::size_t splat_all(const BatchView& view, const BatchRegion& region, const std::uint32_t* voxels, std::size_t count,
                      const PressStamp& press_stamp, std::uint32_t* visible) {
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
    seen += splat_front<V>(view, region, queue, press_stamp, visible + seen);
    queue.drop_front();
  }
  if (queue.count > 0) seen += splat_front<V>(view, region, queue, press_stamp, visible + seen);
  return seen;
}

template <class V>
struct PressCoverage {
  const BatchView& view;
  bool operator()(const Stamp<V>& stamp, int lane, std::uint32_t, std::int32_t place, std::int32_t rows) const {
    return press<V>(view, stamp, lane, place, rows);
  }
};

template <class V>
std::size_t splat_batches(const BatchView& view, const BatchRegion& region, const std::uint32_t* voxels,
                          std::size_t count, std::uint32_t* visible) {
  return splat_all<V>(view, region, voxels, count, PressCoverage<V>{view}, visible);
}

}  // namespace vantage::simd
