#pragma once

#include "vantage/visibility/splat_batch.hpp"

// Where the voxels of a batch are in the image, and the borders of their silhouettes; written once for all vector types
// V, one voxel per lane. See docs/performance.md for the figure to which the names belong. Only templates on V here,
// see splat_batch.hpp.
namespace vantage::simd {

/// What is found out about a batch of voxels before their pixels are looked at, one voxel per lane. A voxel's window
/// are the 16 columns from a strip's border on, and up to 16 rows, that enclose its silhouette.
template <class V>
struct Window {
  typename V::Float column, row;  // the projected centre, from the window's first pixel
  typename V::Float inverse_depth;
  typename V::Int place;                  // of the window's first pixel in the coverage: bytes from pixel (0, 0)
  typename V::Int before, columns, rows;  // the silhouette's bounds in it: columns before them, and their size
  typename V::Int outside;                // mask: no pixel of the frame lies in the silhouette's bounds
  typename V::Int special;                // mask: left to double precision
};

/// The silhouette's borders as columns left[k] + row*left_slope[k] < column < right[k] + row*right_slope[k], for pixels
/// from the window's first one.
template <class V>
struct Borders {
  typename V::Float left[3], left_slope[3], right[3], right_slope[3];
  typename V::Float steepness;  // largest 1/|column| of the half-planes
  typename V::Int special;
};

constexpr float window_side = 16;
constexpr float slope_of_level = 0x1p16F;  // columns per row that stand for a level line
constexpr float levelness = 0x1p-11F;      // lines of a smaller |column/row| are level

/// Where a batch's voxels are.
template <class V>
struct Place {
  typename V::Float index[3];   // from the view's middle voxel
  typename V::Float offset[3];  // of the centre from the camera, in voxels
  typename V::Int in_slab[3];   // mask: the camera is in the same slab of that axis
  typename V::Int few_sides;    // mask: ... on two axes or more, where silhouettes have fewer than six edges
};

template <class V>
Place<V> place_of(const BatchView& view, typename V::Int voxels) {
  using Int = typename V::Int;
  const Int index[3] = {voxels & V::all(1023), (voxels >> 10) & V::all(1023), (voxels >> 20) & V::all(1023)};
  Place<V> place;
  for (int a = 0; a < 3; ++a) {
    place.index[a] = V::to_float(index[a] - V::all(view.middle[a]));
    place.offset[a] = place.index[a] + V::all(view.offset[a]);
    place.in_slab[a] = index[a] == V::all(view.cell[a]);
  }
  place.few_sides = (place.in_slab[0] & place.in_slab[1]) | (place.in_slab[1] & place.in_slab[2]) |
                    (place.in_slab[2] & place.in_slab[0]);
  return place;
}

/// A voxel's centre as (column*depth, row*depth, depth), in double precision: its error would shift all borders.
template <class V>
typename V::Double pixel_of(const BatchView& view, const typename V::Double (&index)[3], int i) {
  typename V::Double sum = V::all(view.pixel_of_middle[i]);
  for (int a = 0; a < 3; ++a) sum = V::multiply_add(V::all(view.pixel_per_voxel[i][a]), index[a], sum);
  return sum;
}

/// How far the silhouette reaches from its centre, in pixels: see extent() in footprint.cpp for the bound.
template <class V>
typename V::Float reach(const double (&pixel)[3], const double (&depth)[3], typename V::Float middle,
                        typename V::Float inverse_nearest) {
  typename V::Float sum = V::all(0.0F);
  for (int a = 0; a < 3; ++a) {
    const auto per_depth = static_cast<float>(depth[a]);
    sum += V::absolute(V::multiply_add(-middle, V::all(per_depth), V::all(static_cast<float>(pixel[a]))));
  }
  return V::all(0.5F) * sum * inverse_nearest;
}

template <class V>
Window<V> window_of(const BatchView& view, const Place<V>& place) {
  using Float = typename V::Float;
  using Int = typename V::Int;
  using Double = typename V::Double;
  const Double index[3] = {V::to_double(place.index[0]), V::to_double(place.index[1]), V::to_double(place.index[2])};
  const Double exact_depth = pixel_of<V>(view, index, 2);
  const Float depth = V::to_float(exact_depth);
  const Float nearest = depth - V::all(view.half_depth);
  const Float farthest = depth + V::all(view.half_depth);
  const Int is_cut = (nearest < V::all(view.nearest_depth)) | (farthest > V::all(view.farthest_depth));
  const Int is_unseen = (farthest < V::all(view.before_depth)) | (nearest > V::all(view.beyond_depth));
  const Float safe_depth = V::max(depth, V::all(view.nearest_depth));
  const Float inverse_depth = V::all(1.0F) / safe_depth;
  const Float inverse_nearest = V::all(1.0F) / V::max(nearest, V::all(view.nearest_depth));
  // One step of Newton's method doubles the digits of the reciprocal.
  const Double rough = V::to_double(inverse_depth);
  const Double exact_inverse = rough * (V::all(2.0) - exact_depth * rough);
  const Double exact_column = pixel_of<V>(view, index, 0) * exact_inverse;
  const Double exact_row = pixel_of<V>(view, index, 1) * exact_inverse;
  const Float column = V::to_float(exact_column);
  const Float row = V::to_float(exact_row);
  const Float column_reach =
      reach<V>(view.pixel_per_voxel[0], view.pixel_per_voxel[2], column, inverse_nearest) + V::all(0.01F);
  const Float row_reach =
      reach<V>(view.pixel_per_voxel[1], view.pixel_per_voxel[2], row, inverse_nearest) + V::all(0.01F);
  const Float far_out = V::all(0x1p20F);  // keeps the conversions to integers in range
  const auto whole = [&](Float x) { return V::floor(V::max(V::min(x, far_out), -far_out)); };
  const Int first_column = whole(column - column_reach) + V::all(view.middle_column + 1);
  const Int last_column = whole(column + column_reach) + V::all(view.middle_column);
  const Int first_row = whole(row - row_reach) + V::all(view.middle_row + 1);
  const Int last_row = whole(row + row_reach) + V::all(view.middle_row);

  Window<V> window;
  window.inverse_depth = inverse_depth;
  window.place = (first_column >> 3) * V::all(view.stride) + first_row;
  window.before = first_column & V::all(7);
  window.columns = last_column - first_column + 1;
  window.rows = last_row - first_row + 1;
  const Int is_off = ((last_column < 0) | (last_row < 0) | (first_column >= V::all(view.columns)) |
                      (first_row >= V::all(view.rows)) | (first_column > last_column) | (first_row > last_row));
  window.outside = is_unseen | (is_off & ~is_cut);
  const Int is_large = (window.before + window.columns > 16) | (window.rows > 16);
  window.special = is_cut | is_large | place.few_sides;
  const auto from = [](Double exact, Int first) { return V::to_float(exact - V::to_double(V::to_float(first))); };
  window.column = from(exact_column, (first_column & V::all(~7)) - V::all(view.middle_column));
  window.row = from(exact_row, first_row - V::all(view.middle_row));
  return window;
}

/// One of a pair's two half-planes, about the projected centre: column*c + row*r + constant > 0.
template <class V>
struct HalfPlane {
  typename V::Float column, row, constant;
};

/// A line's border column as slope*r + offset, and 1/|column|. `sense` has the sign that `column` must have; a level
/// line becomes a very steep one of that sense. Lines that fit neither are special.
template <class V>
struct Border {
  typename V::Float slope, offset, steepness;
  typename V::Int special;
};

template <class V>
Border<V> border_of(const BatchView& view, const Window<V>& window, const HalfPlane<V>& line, typename V::Float sense) {
  using Float = typename V::Float;
  using Int = typename V::Int;
  const Float column_size = V::absolute(line.column);
  const Float row_size = V::absolute(line.row);
  const Int is_level = column_size <= V::all(levelness) * row_size;
  const Int is_against = line.column * sense <= V::all(0.0F);
  Border<V> border;
  border.special = is_against & ~is_level;
  Float column = line.column;
  border.steepness = V::all(0.0F);
  if (V::lane_bits(is_level) != 0) {
    column = V::select(is_level, sense * V::max(row_size, V::all(0x1p-60F)) * V::all(1 / slope_of_level), column);
    // The row in which the line lies must be told apart from the pixels' rows.
    const Float far_off = V::all(0x1p20F);
    const Float crossing = V::max(V::min(window.row - line.constant / line.row, far_off), -far_off);
    const Float doubt = V::all(view.row_error + 64 / slope_of_level) +
                        (V::all(2 * window_side) * column_size + V::all(view.line_error)) / row_size;
    const Float near_row = V::absolute(crossing - V::to_float(V::floor(crossing + V::all(0.5F))));
    border.special |= is_level & ~(near_row > doubt);
  }
  const Float inverse = V::all(1.0F) / column;
  border.steepness = V::select(is_level, V::all(0.0F), V::absolute(inverse));
  border.slope = -line.row * inverse;
  border.offset = V::multiply_add(-border.slope, window.row, -line.constant * inverse) + window.column;
  return border;
}

/// In the camera's slab of axis a the ray need not enter a: its silhouette's edge lies on the near face of b.
template <class V>
void move_to_near_face(const BatchView& view, const BatchRegion& region, const Place<V>& place, int a,
                       const Window<V>& window, HalfPlane<V>& line) {
  using Float = typename V::Float;
  const Float one = V::select(place.in_slab[a], V::all(region.side[a]), V::all(0.0F));
  line.column -= one * V::all(view.per_column[a]);
  line.row -= one * V::all(view.per_row[a]);
  line.constant -= one * place.offset[a] * window.inverse_depth;
}

/// Both half-planes of pair c.
template <class V>
void lines_of(const BatchView& view, const BatchRegion& region, const Place<V>& place, const Window<V>& window, int c,
              HalfPlane<V> (&lines)[2]) {
  using Float = typename V::Float;
  const int a = (c + 1) % 3;
  const int b = (c + 2) % 3;
  const BatchPair& pair = region.pair[c];
  const Float column = V::multiply_add(V::all(pair.column_per_voxel[0]), place.index[a],
                                       V::all(pair.column_per_voxel[1]) * place.index[b]);
  const Float row =
      V::multiply_add(V::all(pair.row_per_voxel[0]), place.index[a], V::all(pair.row_per_voxel[1]) * place.index[b]);
  const Float constant =
      V::multiply_add(V::all(0.5F * region.side[a]), place.offset[a], V::all(0.5F * region.side[b]) * place.offset[b]) *
      window.inverse_depth;
  lines[0] = {V::all(pair.column_of_middle[0]) + column, V::all(pair.row_of_middle[0]) + row, constant};
  lines[1] = {V::all(pair.column_of_middle[1]) - column, V::all(pair.row_of_middle[1]) - row, constant};
  if (V::lane_bits(place.in_slab[a]) != 0) move_to_near_face<V>(view, region, place, a, window, lines[0]);
  if (V::lane_bits(place.in_slab[b]) != 0) move_to_near_face<V>(view, region, place, b, window, lines[1]);
}

template <class V>
Borders<V> borders_of(const BatchView& view, const BatchRegion& region, const Place<V>& place,
                      const Window<V>& window) {
  using Float = typename V::Float;
  Borders<V> borders;
  borders.steepness = V::all(0.0F);
  borders.special = V::all(0);
  for (int c = 0; c < 3; ++c) {
    HalfPlane<V> lines[2];
    lines_of<V>(view, region, place, window, c, lines);
    // One border is on the left and one on the right; the first is on the left where its column is positive.
    const auto is_first_left = lines[0].column >= lines[1].column;
    const Float sense = V::select(is_first_left, V::all(1.0F), V::all(-1.0F));
    const Border<V> first = border_of<V>(view, window, lines[0], sense);
    const Border<V> second = border_of<V>(view, window, lines[1], -sense);
    borders.left[c] = V::select(is_first_left, first.offset, second.offset);
    borders.left_slope[c] = V::select(is_first_left, first.slope, second.slope);
    borders.right[c] = V::select(is_first_left, second.offset, first.offset);
    borders.right_slope[c] = V::select(is_first_left, second.slope, first.slope);
    borders.steepness = V::max(borders.steepness, V::max(first.steepness, second.steepness));
    borders.special |= first.special | second.special;
  }
  return borders;
}

}  // namespace vantage::simd
