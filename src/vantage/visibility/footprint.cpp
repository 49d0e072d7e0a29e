#include "vantage/visibility/footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vantage {
namespace {

/// Bound on the rounding of a half-plane's terms, relative to their size; generous.
constexpr double line_rounding = 0x1p-46;
/// Lines that move by more than this many columns under rounding are taken as level.
constexpr double largest_column_error = 0x1p-10;

/// A range of whole numbers, both ends inclusive.
struct Span {
  int first = 0, last = -1;
};

Span whole_numbers(double low, double high, int count) {
  return {static_cast<int>(std::ceil(std::clamp(low, 0.0, static_cast<double>(count)))),
          static_cast<int>(std::floor(std::clamp(high, -1.0, static_cast<double>(count - 1))))};
}

/// Where column*c + row*r + constant > 0, to within +-error.
struct HalfPlane {
  double column, row, constant, error;
};

/// A slanted half-plane's border as a column for every row.
struct Border {
  double slope, offset;
  [[nodiscard]] double at(int row) const { return slope * row + offset; }
};

/// The pixels whose rays pass a voxel: those that leave no axis before they have entered all others. Each condition
/// "enters axis b before it leaves axis a" is a half-plane, whose border is the image of the lattice edge in which both
/// planes meet.
class Silhouette {
 public:
  Silhouette(const PixelFrame& frame, const Index3& voxel) : frame_(frame) {
    const Index3 cell = frame.local_cell();
    for (int b = 0; b < 3; ++b) {
      if (voxel[b] == cell[b]) continue;  // the camera is in this slab: the ray need not enter it
      const int toward = voxel[b] > cell[b] ? 1 : -1;
      const double enter = toward * frame.plane(b, toward > 0 ? voxel[b] : voxel[b] + 1);
      for (int a = 0; a < 3; ++a) {
        if (a == b) continue;
        if (voxel[a] >= cell[a]) add(a, 1, frame.plane(a, voxel[a] + 1), b, toward, enter);
        if (voxel[a] <= cell[a]) add(a, -1, -frame.plane(a, voxel[a]), b, toward, enter);
      }
    }
  }

  /// Columns of a row that may pass the voxel (`outer`) and those of them that surely do (`inner`).
  struct Row {
    Span outer, inner;
  };
  [[nodiscard]] Row at(int row) const {
    const int columns = frame_.resolution.columns;
    double left = -2;
    double right = columns + 1;
    for (int i = 0; i < lefts_; ++i) left = std::max(left, left_[static_cast<std::size_t>(i)].at(row));
    for (int i = 0; i < rights_; ++i) right = std::min(right, right_[static_cast<std::size_t>(i)].at(row));
    Row spans{whole_numbers(left - error_, right + error_, columns),
              whole_numbers(left + error_, right - error_, columns)};
    for (int i = 0; i < levels_; ++i) {
      const HalfPlane& level = level_[static_cast<std::size_t>(i)];
      const double value = level.row * row + level.constant;
      const double doubt = level.error + std::abs(level.column) * columns;
      if (value < -doubt) return {};
      if (value <= doubt) spans.inner = {};
    }
    return spans;
  }

 private:
  /// The ray enters axis b (plane at distance `enter`) before it leaves axis a (plane at distance `leave`):
  /// enter / |d_b| < leave / |d_a|, and d is linear in column and row.
  void add(int a, int sign_a, double leave, int b, int sign_b, double enter) {
    const Vec3 line = leave * sign_b * frame_.directions.row(b) - enter * sign_a * frame_.directions.row(a);
    const double error = line_rounding * (std::abs(leave) + std::abs(enter)) * frame_.longest;
    if (!(error < largest_column_error * std::abs(line[0]))) {
      level_[static_cast<std::size_t>(levels_++)] = {line[0], line[1], line[2], error};
      return;
    }
    error_ = std::max(error_, error / std::abs(line[0]));
    const Border border{-line[1] / line[0], -line[2] / line[0]};
    if (line[0] > 0) {
      left_[static_cast<std::size_t>(lefts_++)] = border;
    } else {
      right_[static_cast<std::size_t>(rights_++)] = border;
    }
  }

  const PixelFrame& frame_;
  std::array<Border, 6> left_{}, right_{};
  std::array<HalfPlane, 6> level_{};
  int lefts_ = 0, rights_ = 0, levels_ = 0;
  double error_ = 0;  // of the borders, in columns
};

/// Rows and columns that a voxel's image can meet, and whether a depth limit may cut the voxel.
struct Window {
  Span rows, columns;
  bool cut = false;
};

/// Pixel coordinate i (0 column, 1 row) of the voxel's image. The centre projects to m; a corner at half a voxel d off
/// projects to m + (K_i - m K_2).d / (depth + K_2.d), where K are the rows of pixel_from_offset.
Span extent(const PixelFrame& frame, const Vec3& projected, int i, int count) {
  const double nearest = projected.z() - frame.half_extent.z();
  if (!(nearest > 1e-6 * projected.z())) return {0, count - 1};
  const double middle = projected[i] / projected.z();
  const double reach =
      0.5 * (frame.pixel_from_offset.row(i) - middle * frame.pixel_from_offset.row(2)).cwiseAbs().sum() / nearest;
  const double slack = 1e-6 * (1 + std::abs(middle) + reach);
  return whole_numbers(middle - reach - slack, middle + reach + slack, count);
}

/// The part of the frame where the voxel may be seen; none where the depth limits or the frame leave it out.
std::optional<Window> window(const PixelFrame& frame, const Index3& voxel) {
  const Vec3 projected = frame.pixel_from_offset * frame.center(voxel);
  const double slack = 1e-6 * (1 + std::abs(projected.z()));
  const double nearest = projected.z() - frame.half_extent.z();
  const double farthest = projected.z() + frame.half_extent.z();
  const double near = frame.near / frame.grid.length;
  const double far = frame.far / frame.grid.length;
  if (farthest < near - slack || nearest > far + slack) return std::nullopt;
  const int size[2] = {frame.resolution.columns, frame.resolution.rows};
  for (int i = 0; i < 2; ++i) {  // wholly to one side of the frame?
    const int last = size[i] - 1;
    const Vec3 from_last = (last * frame.pixel_from_offset.row(2) - frame.pixel_from_offset.row(i)).transpose();
    const double within = 1e-6 * (std::abs(projected[i]) + last * std::abs(projected.z()) + frame.half_extent[i]);
    if (projected[i] + frame.half_extent[i] < -within) return std::nullopt;
    if (last * projected.z() - projected[i] + 0.5 * from_last.cwiseAbs().sum() < -within) return std::nullopt;
  }
  return Window{extent(frame, projected, 1, size[1]), extent(frame, projected, 0, size[0]),
                nearest < near + slack || farthest > far - slack};
}

/// Calls `cover(row, first, last, first_sure, last_sure, hits)` for every row that the voxel's image meets.
template <class CoverRow>
bool splat_rows(const PixelFrame& frame, const Index3& voxel, const CoverRow& cover) {
  const std::optional<Window> part = window(frame, voxel);
  if (!part) return false;
  const Silhouette silhouette(frame, voxel);
  bool visible = false;
  for (int row = part->rows.first; row <= part->rows.last; ++row) {
    auto [outer, inner] = silhouette.at(row);
    outer = {std::max(outer.first, part->columns.first), std::min(outer.last, part->columns.last)};
    if (outer.first > outer.last) continue;
    if (part->cut) inner = {};
    visible |= cover(row, outer.first, outer.last, inner.first, inner.last,
                     [&](int column) { return frame.ray_passes(column, row, voxel); });
  }
  return visible;
}

}  // namespace

bool splat(const PixelFrame& frame, const Index3& voxel, Coverage& coverage) {
  return splat_rows(frame, voxel, [&](auto... row) { return coverage.cover_row(row...); });
}

bool splat_once(const PixelFrame& frame, const Index3& voxel, Coverage& ended, Coverage& passed) {
  return splat_rows(frame, voxel, [&](auto... row) { return ended.pass_row(passed, row...); });
}

}  // namespace vantage
