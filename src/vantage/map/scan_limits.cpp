#include "vantage/map/scan_limits.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/parallel.hpp"
#include "vantage/map/voxel_ray.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {
namespace {

constexpr int finest_shift = 2;       // tiles of 4x4 pixels
constexpr int rows_per_band = 32;     // one task each
constexpr int cell_offset = 1 << 20;  // makes cells positive, so that truncation rounds down

std::int64_t steps_between(const Index3& a, const Index3& b) { return (a - b).cast<std::int64_t>().cwiseAbs().sum(); }

/// Reads one row of pixels after the other. The voxels in which rays end come from plain loops over the columns, which
/// compilers turn into vector code; the few rays that end next to a lattice plane are redone exactly.
class RowReader {
 public:
  RowReader(const VoxelMap& map, const RangeImage& image, const View& view, const StepCounts& steps)
      : map_(map), image_(image), view_(view), steps_(steps), rays_(image.camera.rays()) {
    const Box3 space = map.grid().box(map.enclosure());
    const Vec3 eye = view.position();
    // A ray that meets nothing need not be followed beyond the enclosure.
    const double beyond = distance_beyond(map.grid(), map.enclosure(), eye);
    far_limit_cuts_ = image.camera.max_depth < beyond;
    far_ = std::min(image.camera.max_depth, beyond);
    const double largest_coordinate =
        std::max({space.min().cwiseAbs().maxCoeff(), space.max().cwiseAbs().maxCoeff(), eye.cwiseAbs().maxCoeff()});
    least_certainty_ = 1e-6 + 0x1p-44 * largest_coordinate / map.grid().length;
    const auto columns = static_cast<std::size_t>(rays_.resolution.columns);
    for (int column = 0; column < rays_.resolution.columns; ++column) {
      const Vec3 sideways = view.world_from_sensor.linear().col(0) * rays_.x(column);
      for (std::size_t a = 0; a < 3; ++a) sideways_[a].push_back(sideways[static_cast<int>(a)]);
    }
    for (std::vector<std::int32_t>& cells : cells_) cells.resize(columns);
    end_depth_.resize(columns);
    certainty_.resize(columns);
    needs_care_.resize(columns);
  }

  void read(int row, std::span<PixelLimits> limits, std::vector<ScanPoint>& points) {
    const std::span<const float> depth =
        std::span(image_.depth).subspan(static_cast<std::size_t>(row) * limits.size(), limits.size());
    for (std::size_t i = 0; i < limits.size(); ++i) limits[i] = limits_without_end(depth[i]);
    const auto [first, last] = columns_with_ends(depth);
    find_cells(row, depth, first, last);
    set_limits(depth, limits, first, last);
    for (std::size_t i = first; i < last; ++i) {
      if (needs_care_[i] == 0) continue;
      const int column = static_cast<int>(i);
      Index3 cell(cells_[0][i], cells_[1][i], cells_[2][i]);
      if (certainty_[i] < least_certainty_) {
        const LatticeRay ray(map_.grid(), view_.position(),
                             ray_direction(view_.world_from_sensor.linear(), rays_.x(column), rays_.y(row)));
        if (RangeImage::is_hit(depth[i])) {
          cell = map_.grid().index_of(Vec3(ray.origin + static_cast<double>(depth[i]) * ray.direction)) -
                 map_.enclosure().min;
          limits[i] = limits_of_hit(cell);
        } else {
          const std::int64_t crossings = crossings_until(map_.grid(), ray, far_);
          limits[i] = {clamped(crossings + 1 - steps_.first), nothing_occluded()};
        }
      }
      if (RangeImage::is_hit(depth[i]) && is_inside(cell)) {
        points.push_back({row * rays_.resolution.columns + column, cell});
      }
    }
  }

 private:
  [[nodiscard]] std::int16_t nothing_occluded() const { return static_cast<std::int16_t>(steps_.endless()); }
  [[nodiscard]] std::int16_t clamped(std::int64_t steps) const {
    return static_cast<std::int16_t>(std::clamp<std::int64_t>(steps, 0, steps_.endless()));
  }
  [[nodiscard]] bool is_inside(const Index3& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < map_.layout().size.array()).all();
  }
  [[nodiscard]] PixelLimits limits_of_hit(const Index3& cell) const {
    const std::int16_t steps = clamped(steps_between(cell, steps_.eye) - steps_.first);
    return {steps, is_inside(cell) ? steps : nothing_occluded()};
  }

  /// What a pixel says whose ray has no end in reach: it empties all of its voxels, or is unknown.
  [[nodiscard]] PixelLimits limits_without_end(float depth) const {
    return {depth > 0 ? nothing_occluded() : PixelLimits::unknown, nothing_occluded()};
  }

  /// The columns from the first to the last ray that ends, `last` excluded: at a hit, or at the far limit.
  [[nodiscard]] std::pair<std::size_t, std::size_t> columns_with_ends(std::span<const float> depth) const {
    if (far_limit_cuts_) return {0, depth.size()};
    const auto first = std::find_if(depth.begin(), depth.end(), RangeImage::is_hit);
    const auto last = std::find_if(depth.rbegin(), std::make_reverse_iterator(first), RangeImage::is_hit).base();
    return {static_cast<std::size_t>(first - depth.begin()), static_cast<std::size_t>(last - depth.begin())};
  }

  /// The voxels, local to the enclosure, in which the rays of a row end, and how far (in voxels) from a lattice plane.
  void find_cells(int row, std::span<const float> depth, std::size_t first, std::size_t last) {
    const Grid& grid = map_.grid();
    for (std::size_t i = first; i < last; ++i) {
      end_depth_[i] = RangeImage::is_hit(depth[i]) ? static_cast<double>(depth[i]) : far_;
      certainty_[i] = 1;
    }
    const Mat3 rotation = view_.world_from_sensor.linear();
    for (int a = 0; a < 3; ++a) {
      const double down = rotation(a, 1) * rays_.y(row);
      const double forward = rotation(a, 2);
      const double origin = view_.position()[a];
      const double first_plane = grid.plane(a, map_.enclosure().min[a]);
      const double per_length = 1 / grid.length;
      const double* const sideways = sideways_[static_cast<std::size_t>(a)].data();
      const double* const end_depth = end_depth_.data();
      double* const certainty = certainty_.data();
      std::int32_t* const cells = cells_[static_cast<std::size_t>(a)].data();
      for (std::size_t i = first; i < last; ++i) {
        const double coordinate = origin + end_depth[i] * ((sideways[i] + down) + forward);
        const double place = (coordinate - first_plane) * per_length + cell_offset;
        const double clamped_place = std::min(std::max(place, 0.0), 2.0 * cell_offset);
        const auto cell = static_cast<std::int32_t>(clamped_place);
        const double fraction = clamped_place - cell;
        certainty[i] = std::min(certainty[i], std::min(fraction, 1 - fraction));  // 0 where it was clamped
        cells[i] = cell - cell_offset;
      }
    }
  }

  void set_limits(std::span<const float> depth, std::span<PixelLimits> limits, std::size_t first, std::size_t last) {
    const auto [eye_x, eye_y, eye_z] = std::array{steps_.eye.x(), steps_.eye.y(), steps_.eye.z()};
    const auto size = map_.layout().size.cast<std::uint32_t>().eval();
    const std::int32_t* const x = cells_[0].data();
    const std::int32_t* const y = cells_[1].data();
    const std::int32_t* const z = cells_[2].data();
    const int most = steps_.endless();
    for (std::size_t i = first; i < last; ++i) {
      const bool is_known = depth[i] > 0;
      const bool is_hit = RangeImage::is_hit(depth[i]);
      const int steps = std::abs(x[i] - eye_x) + std::abs(y[i] - eye_y) + std::abs(z[i] - eye_z) - steps_.first;
      // A ray that meets nothing also empties the voxel that it ends in.
      const int emptied = std::clamp(steps + (is_hit ? 0 : 1), 0, most);
      // NOLINTNEXTLINE(clang-diagnostic-bitwise-instead-of-logical): without branches the loop becomes vector code.
      const bool is_point = is_hit & (static_cast<std::uint32_t>(x[i]) < size.x()) &
                            (static_cast<std::uint32_t>(y[i]) < size.y()) &
                            (static_cast<std::uint32_t>(z[i]) < size.z());
      limits[i] = {static_cast<std::int16_t>(is_known ? emptied : PixelLimits::unknown),
                   static_cast<std::int16_t>(is_point ? steps : most)};
      needs_care_[i] = static_cast<std::uint8_t>(is_known & (is_point | (certainty_[i] < least_certainty_)));
    }
  }

  const VoxelMap& map_;
  const RangeImage& image_;
  const View& view_;
  const StepCounts& steps_;
  RayGrid rays_;
  bool far_limit_cuts_ = false;
  double far_ = 0;  // depth at which rays without a return end
  double least_certainty_ = 0;
  std::array<std::vector<double>, 3> sideways_;  // per axis and column: the part of the direction along the rows
  std::array<std::vector<std::int32_t>, 3> cells_;
  std::vector<double> end_depth_, certainty_;
  std::vector<std::uint8_t> needs_care_;
};

}  // namespace

StepCounts::StepCounts(const Index3& enclosure_size, const Index3& local_eye) : eye(local_eye) {
  const auto [least, most] = range(Index3::Zero(), enclosure_size);
  first = least;
  span = most - least;
}

std::pair<int, int> StepCounts::range(const Index3& low, const Index3& high) const {
  const Index3 last = high - Index3::Ones();
  const Index3 nearest = eye.cwiseMax(low).cwiseMin(last);
  return {of(nearest), ((eye - low).cwiseAbs().cwiseMax((eye - last).cwiseAbs())).sum() - first};
}

void ScanLimits::prepare(const VoxelMap& map, const RangeImage& image, const View& view, const StepCounts& steps) {
  resolution_ = image.camera.resolution;
  pixels_.resize(image.depth.size());
  const int bands = (resolution_.rows + rows_per_band - 1) / rows_per_band;
  points_.resize(static_cast<std::size_t>(bands));
  parallel_for(points_.size(), [&](std::size_t band) {
    points_[band].clear();
    RowReader reader(map, image, view, steps);
    const auto columns = static_cast<std::size_t>(resolution_.columns);
    const int first = static_cast<int>(band) * rows_per_band;
    for (int row = first; row < std::min(first + rows_per_band, resolution_.rows); ++row) {
      reader.read(row, std::span(pixels_).subspan(static_cast<std::size_t>(row) * columns, columns), points_[band]);
    }
  });
  build_tiles();
}

void ScanLimits::build_tiles() {
  std::size_t level = 0;
  const auto tiles_of = [&](int columns, int rows) -> Tiles& {
    if (levels_.size() <= level) levels_.emplace_back();
    Tiles& tiles = levels_[level++];
    tiles.columns = columns;
    tiles.ranges.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    return tiles;
  };
  constexpr int side = 1 << finest_shift;
  int columns = (resolution_.columns + side - 1) / side;
  int rows = (resolution_.rows + side - 1) / side;
  Tiles& finest = tiles_of(columns, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      LimitRange range(at(side * column, side * row));
      for (int y = side * row; y < std::min(side * (row + 1), resolution_.rows); ++y) {
        const PixelLimits* const pixels = row_of(y);
        for (int x = side * column; x < std::min(side * (column + 1), resolution_.columns); ++x) {
          range.join(LimitRange(pixels[x]));
        }
      }
      finest.at(column, row) = range;
    }
  }
  while (columns > 1 || rows > 1) {
    const int finer_columns = columns;
    const int finer_rows = rows;
    columns = (columns + 1) / 2;
    rows = (rows + 1) / 2;
    Tiles& coarser = tiles_of(columns, rows);
    Tiles& finer = levels_[level - 2];
    for (int row = 0; row < rows; ++row) {
      const int below = std::min(2 * row + 1, finer_rows - 1);
      for (int column = 0; column < columns; ++column) {
        const int right = std::min(2 * column + 1, finer_columns - 1);
        LimitRange& range = coarser.at(column, row);
        range = finer.at(2 * column, 2 * row);
        range.join(finer.at(right, 2 * row));
        range.join(finer.at(2 * column, below));
        range.join(finer.at(right, below));
      }
    }
  }
  levels_.resize(level);
}

LimitRange ScanLimits::range(const PixelRect& rect) const {
  constexpr int most_tiles = 8;  // along each side of the rectangle
  int shift = finest_shift;
  while (std::max(rect.right - rect.left, rect.bottom - rect.top) >> shift >= most_tiles) ++shift;
  const Tiles& tiles = levels_[static_cast<std::size_t>(shift - finest_shift)];
  LimitRange range = tiles.at(rect.left >> shift, rect.top >> shift);
  for (int row = rect.top >> shift; row <= rect.bottom >> shift; ++row) {
    for (int column = rect.left >> shift; column <= rect.right >> shift; ++column) {
      range.join(tiles.at(column, row));
    }
  }
  return range;
}

}  // namespace vantage
