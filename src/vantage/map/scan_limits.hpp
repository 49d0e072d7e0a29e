#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vantage/map/evidence.hpp"
#include "vantage/map/lattice_projection.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// Steps of a voxel: the lattice planes between it and the camera's voxel, |dx| + |dy| + |dz|. They grow by one per
/// crossing along any ray. Here they count from `first`, the least of any voxel of the enclosure, so that 16 bits do.
struct StepCounts {
  Index3 eye;  // the camera's voxel, local to the enclosure
  int first = 0;
  int span = 0;  // the largest count of any voxel of the enclosure

  static constexpr int largest_span = 32000;
  /// More than any voxel has, and than any voxel that is looked through by the last rays that matter.
  [[nodiscard]] int endless() const { return span + 1 + steps_looked_through; }

  StepCounts(const Index3& enclosure_size, const Index3& local_eye);
  [[nodiscard]] int of(const Index3& local) const { return (local - eye).cwiseAbs().sum() - first; }
  /// The least and the largest count in the block of voxels from `low` up to but without `high`.
  [[nodiscard]] std::pair<int, int> range(const Index3& low, const Index3& high) const;
};

/// What a pixel says about the voxels that its ray passes: those with steps < `emptied_below` become empty, those with
/// steps > `occluded_above` become occluded, those with steps + steps_looked_through < `emptied_below` are looked
/// through. Both are clamped to 0 .. endless; 0 empties nothing, endless occludes nothing. An unknown pixel says
/// nothing.
struct PixelLimits {
  static constexpr std::int16_t unknown = -1;

  std::int16_t emptied_below;
  std::int16_t occluded_above;
};

/// Extremes of the limits over some pixels.
class LimitRange {
 public:
  explicit LimitRange(const PixelLimits& pixel)
      : lanes_{pixel.emptied_below, static_cast<std::int16_t>(-pixel.emptied_below), pixel.occluded_above,
               static_cast<std::int16_t>(-pixel.occluded_above)} {}
  LimitRange() = default;

  [[nodiscard]] int most_emptied() const { return lanes_[0]; }
  [[nodiscard]] int least_emptied() const { return -lanes_[1]; }
  [[nodiscard]] int most_occluded() const { return lanes_[2]; }
  [[nodiscard]] int least_occluded() const { return -lanes_[3]; }
  void join(const LimitRange& other) { lanes_ = lanes_ > other.lanes_ ? lanes_ : other.lanes_; }

 private:
  // The least ones negated, so that one vector instruction joins all four.
  using Lanes = std::int16_t __attribute__((vector_size(8)));
  Lanes lanes_;
};

/// A measured point in the enclosure.
struct ScanPoint {
  std::int32_t pixel;
  Index3 voxel;  // local to the enclosure
};

/// The limits of all pixels of a scan with a pyramid of their extremes, and the measured points in the enclosure.
class ScanLimits {
 public:
  void prepare(const VoxelMap& map, const RangeImage& image, const View& view, const StepCounts& steps);

  [[nodiscard]] PixelLimits at(int column, int row) const { return row_of(row)[column]; }
  [[nodiscard]] const PixelLimits* row_of(int row) const {
    return pixels_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution_.columns);
  }
  /// Extremes over at least the pixels of `rect`, at most over the tiles that it touches.
  [[nodiscard]] LimitRange range(const PixelRect& rect) const;
  /// One band of rows after the other, in the order of the pixels.
  [[nodiscard]] std::span<const std::vector<ScanPoint>> points() const { return points_; }

 private:
  struct Tiles {
    int columns = 0;
    std::vector<LimitRange> ranges;

    [[nodiscard]] std::size_t place(int column, int row) const {
      return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    }
    [[nodiscard]] const LimitRange& at(int column, int row) const { return ranges[place(column, row)]; }
    [[nodiscard]] LimitRange& at(int column, int row) { return ranges[place(column, row)]; }
  };

  void build_tiles();

  Resolution resolution_;
  std::vector<PixelLimits> pixels_;
  std::vector<Tiles> levels_;  // of 4x4 pixels, 8x8, ...
  std::vector<std::vector<ScanPoint>> points_;
};

}  // namespace vantage
