#include "vantage/visibility/batch_view.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr double float_rounding = 0x1p-24;
constexpr double double_rounding = 0x1p-50;
constexpr double window_reach = 17;  // pixels of a window from the projected centre, at most

/// What the bounds on rounding are made of.
struct Sizes {
  Vec3 half;                     // half the enclosure, voxels
  double coordinate;             // error of a lattice plane's offset, voxels
  double distance;               // farthest voxel on any axis
  double depth;                  // least depth of a voxel that is not left to double precision
  double column_step, row_step;  // largest component of a direction's change per column and per row
};

/// Error of a projected centre in pixels: double precision, then a float within the window.
double center_error(const Sizes& sizes, const Mat3& pixel_per_voxel, const Vec3& at_middle, int i, int pixels) {
  const auto sum_error = [&](int row) {
    const double terms = pixel_per_voxel.row(row).cwiseAbs().dot(sizes.half);
    return 16 * double_rounding * (std::abs(at_middle[row]) + terms) +
           sizes.coordinate * pixel_per_voxel.row(row).cwiseAbs().sum();
  };
  return (sum_error(i) + (pixels + 32) * sum_error(2)) / sizes.depth + 1e-12 * (pixels + 32) +
         2 * float_rounding * window_reach;
}

void set_line_errors(BatchView& batch, const Sizes& sizes) {
  // Coefficients are a constant plus two products with an index. They err by 6 roundings of the products and 2 of
  // themselves; the latter make up column_error where they are the column's.
  const double products = sizes.half.maxCoeff() * 2 + 2;
  const double largest_row = (2 * sizes.distance + 2) * sizes.row_step;
  const double line_error = window_reach * 6 * float_rounding * products * (sizes.column_step + sizes.row_step) +
                            window_reach * 2 * float_rounding * largest_row +
                            window_reach * 4 * sizes.coordinate * (sizes.column_step + sizes.row_step) +
                            8 * float_rounding * (sizes.distance / sizes.depth);
  batch.line_error = static_cast<float>(line_error);
  batch.column_error += static_cast<float>(64 * float_rounding * window_reach);
  batch.column_error_of_steepness =
      static_cast<float>(line_error + (static_cast<double>(batch.row_error) + 64 * float_rounding) * largest_row);
}

void set_depth_limits(BatchView& batch, const PixelFrame& frame, double distance) {
  const double near = frame.near / frame.grid.length;
  const double far = frame.far / frame.grid.length;
  const double slack = 1e-5 * (1 + distance);
  const auto set = [](float& limit, double value) { limit = static_cast<float>(std::clamp(value, -1e30, 1e30)); };
  set(batch.half_depth, frame.half_extent.z() + slack);
  set(batch.before_depth, near * (1 - 1e-6) - slack);
  set(batch.beyond_depth, far * (1 + 1e-6) + slack);
  set(batch.nearest_depth, std::max(near * (1 + 1e-6) + slack, distance / 16));
  set(batch.farthest_depth, far * (1 - 1e-6) - slack);
}

}  // namespace

BatchView batch_view(const PixelFrame& frame, Coverage& coverage) {
  BatchView batch{};
  batch.middle_column = frame.resolution.columns / 2;
  batch.middle_row = frame.resolution.rows / 2;
  batch.columns = frame.resolution.columns;
  batch.rows = frame.resolution.rows;
  const Index3 size = frame.enclosure.size();
  const Index3 middle = size / 2;
  const Vec3 offset = frame.center(middle);
  Mat3 pixel_per_voxel = frame.pixel_from_offset;
  pixel_per_voxel.row(0) -= batch.middle_column * pixel_per_voxel.row(2);
  pixel_per_voxel.row(1) -= batch.middle_row * pixel_per_voxel.row(2);
  const Vec3 at_middle = pixel_per_voxel * offset;
  for (int a = 0; a < 3; ++a) {
    batch.middle[a] = middle[a];
    batch.cell[a] = frame.local_cell()[a];
    batch.offset[a] = static_cast<float>(offset[a]);
    batch.pixel_of_middle[a] = at_middle[a];
    batch.per_column[a] = static_cast<float>(frame.directions(a, 0));
    batch.per_row[a] = static_cast<float>(frame.directions(a, 1));
    for (int b = 0; b < 3; ++b) batch.pixel_per_voxel[a][b] = pixel_per_voxel(a, b);
  }

  Sizes sizes{};
  sizes.half = 0.5 * size.cast<double>();
  sizes.distance = (offset.cwiseAbs() + sizes.half).maxCoeff() + 1;
  set_depth_limits(batch, frame, sizes.distance);
  const double length = frame.grid.length;
  const double coordinates = frame.grid.min.cwiseAbs().maxCoeff() + frame.origin.cwiseAbs().maxCoeff() +
                             length * frame.enclosure.max.cwiseAbs().maxCoeff();
  sizes.coordinate = double_rounding * coordinates / length;
  sizes.depth = std::max(static_cast<double>(batch.nearest_depth),
                         at_middle.z() - pixel_per_voxel.row(2).cwiseAbs().dot(sizes.half));
  sizes.column_step = frame.directions.col(0).cwiseAbs().maxCoeff();
  sizes.row_step = frame.directions.col(1).cwiseAbs().maxCoeff();
  batch.column_error = static_cast<float>(center_error(sizes, pixel_per_voxel, at_middle, 0, batch.columns));
  batch.row_error = static_cast<float>(center_error(sizes, pixel_per_voxel, at_middle, 1, batch.rows));
  set_line_errors(batch, sizes);

  batch.strips = coverage.first_strip();
  batch.stride = coverage.stride();
  return batch;
}

BatchRegion batch_region(const PixelFrame& frame, const Region& region) {
  BatchRegion batch{};
  const Vec3 middle = frame.center(frame.enclosure.size() / 2);
  for (int a = 0; a < 3; ++a) {
    batch.side[a] = static_cast<float>(region.side_of(a));
    batch.min[a] = region.box.min[a];
    batch.max[a] = region.box.max[a];
  }
  for (int c = 0; c < 3; ++c) {
    const int a = (c + 1) % 3;
    const int b = (c + 2) % 3;
    const int sides = region.side_of(a) * region.side_of(b);
    // For the direction's change d per column: side_a*side_b*(offset_b*d_a - offset_a*d_b) + (side_a*d_a +
    // side_b*d_b)/2
    const auto set = [&](int step, float(&of_middle)[2], float(&per_voxel)[2]) {
      const double d_a = frame.directions(a, step);
      const double d_b = frame.directions(b, step);
      const double moment = sides * (middle[b] * d_a - middle[a] * d_b);
      const double half = 0.5 * (region.side_of(a) * d_a + region.side_of(b) * d_b);
      of_middle[0] = static_cast<float>(half + moment);
      of_middle[1] = static_cast<float>(half - moment);
      per_voxel[0] = static_cast<float>(-sides * d_b);
      per_voxel[1] = static_cast<float>(sides * d_a);
    };
    set(0, batch.pair[c].column_of_middle, batch.pair[c].column_per_voxel);
    set(1, batch.pair[c].row_of_middle, batch.pair[c].row_per_voxel);
  }
  return batch;
}

}  // namespace vantage
