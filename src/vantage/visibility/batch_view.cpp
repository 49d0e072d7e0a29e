#include "vantage/visibility/batch_view.hpp"

#include <algorithm>

namespace vantage {
namespace {

constexpr double float_rounding = 0x1p-24;
constexpr double double_rounding = 0x1p-50;
constexpr double window_reach = 17;  // pixels of a window from the projected centre, at most

/// Bounds on rounding: of pixel_of_offset and its sums, per row.
Vec3 sum_errors(const Mat3& pixel_per_voxel, const Vec3& at_middle, const Vec3& half_size, double coordinate_error) {
  // Seven roundings: of the constants, of three products and of three sums.
  return 8 * float_rounding * (at_middle.cwiseAbs() + pixel_per_voxel.cwiseAbs() * half_size) +
         coordinate_error * pixel_per_voxel.cwiseAbs().rowwise().sum();
}

void set_errors(BatchView& batch, const PixelFrame& frame, const Mat3& pixel_per_voxel, const Vec3& at_middle,
                const Vec3& offset, const Vec3& half_size) {
  const double length = frame.grid.length;
  const double coordinates = frame.grid.min.cwiseAbs().maxCoeff() + frame.origin.cwiseAbs().maxCoeff() +
                             length * frame.enclosure.max.cwiseAbs().maxCoeff();
  const double coordinate_error = double_rounding * coordinates / length;
  const Vec3 sums = sum_errors(pixel_per_voxel, at_middle, half_size, coordinate_error);
  const double distance = (offset.cwiseAbs() + half_size).maxCoeff() + 1;
  const double slack = sums.z() + 1e-6;
  const double near = frame.near / length;
  const double far = frame.far / length;
  batch.half_depth = static_cast<float>(frame.half_extent.z() + slack);
  batch.before_depth = static_cast<float>(near * (1 - 1e-6) - slack);
  batch.beyond_depth = static_cast<float>(far * (1 + 1e-6) + slack);
  batch.nearest_depth = static_cast<float>(std::max(near * (1 + 1e-6) + slack, distance / 16));
  batch.farthest_depth = static_cast<float>(far * (1 - 1e-6) - slack);

  const double nearest_center = at_middle.z() - pixel_per_voxel.row(2).cwiseAbs().dot(half_size);
  const double depth = std::max(static_cast<double>(batch.nearest_depth), nearest_center);
  const auto center_error = [&](int i, int pixels) {
    return (sums[i] + (0.5 * pixels + 32) * sums.z()) / depth + 6 * float_rounding * (pixels + 32);
  };
  const double column_error = center_error(0, batch.columns);
  const double row_error = center_error(1, batch.rows);
  const double column_step = frame.directions.col(0).cwiseAbs().maxCoeff();
  const double row_step = frame.directions.col(1).cwiseAbs().maxCoeff();
  // A half-plane's two coefficients are differences of products with distances, each rounded up to six times.
  const double line_error =
      window_reach * (24 * float_rounding * distance + 4 * coordinate_error) * (column_step + row_step) +
      16 * float_rounding * (distance / depth + window_reach * (column_step + row_step));
  const double largest_row_term = (2 * distance + 1) * row_step;
  batch.column_error = static_cast<float>(column_error + 64 * float_rounding);
  batch.row_error = static_cast<float>(row_error);
  batch.line_error = static_cast<float>(line_error);
  batch.column_error_of_steepness =
      static_cast<float>(line_error + (row_error + 64 * float_rounding) * largest_row_term);
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
    batch.middle[a] = static_cast<float>(middle[a]);
    batch.offset[a] = static_cast<float>(offset[a]);
    batch.pixel_of_offset[a] = static_cast<float>(at_middle[a]);
    batch.per_column[a] = static_cast<float>(frame.directions(a, 0));
    batch.per_row[a] = static_cast<float>(frame.directions(a, 1));
    for (int b = 0; b < 3; ++b) batch.pixel_per_voxel[a][b] = static_cast<float>(pixel_per_voxel(a, b));
  }
  set_errors(batch, frame, pixel_per_voxel, at_middle, offset, 0.5 * size.cast<double>());
  batch.tiles = coverage.first_tile();
  batch.stride = coverage.stride();
  return batch;
}

bool is_batch_region(const Region& region) { return std::count(region.side.begin(), region.side.end(), 0) <= 1; }

BatchRegion batch_region(const PixelFrame& frame, const Region& region) {
  BatchRegion batch{};
  for (int a = 0; a < 3; ++a) batch.side[a] = region.side_of(a) < 0 ? -1.0F : 1.0F;
  for (int c = 0; c < 3; ++c) {
    const int axes[2] = {(c + 1) % 3, (c + 2) % 3};
    BatchPair& pair = batch.pair[c];
    for (int i = 0; i < 2; ++i) {
      const int a = axes[i];
      const int b = axes[1 - i];
      const double half = region.side_of(a) == 0 ? -0.5 : 0.5;
      const double side_a = static_cast<double>(batch.side[a]);
      const double side_b = static_cast<double>(batch.side[b]);
      pair.half[i] = static_cast<float>(half);
      pair.column[i] =
          static_cast<float>(half * side_a * frame.directions(a, 0) + 0.5 * side_b * frame.directions(b, 0));
      pair.row[i] = static_cast<float>(half * side_a * frame.directions(a, 1) + 0.5 * side_b * frame.directions(b, 1));
    }
  }
  return batch;
}

}  // namespace vantage
