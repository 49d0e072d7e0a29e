#pragma once

#include <optional>
#include <vector>

#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// What one frame saw, as the least and the greatest depth around each direction.
class DepthMap {
 public:
  DepthMap() = default;
  /// Blocks of pixels, at most 160 along a side. Pixels that say nothing make their block unknown.
  explicit DepthMap(const RangeImage& image);
  /// Of points in the sensor's frame, z forward, in cells wide enough to have one where there is a surface.
  explicit DepthMap(const std::vector<Vec3>& points);

  [[nodiscard]] bool empty() const { return columns_ == 0; }

  struct Range {
    double least = 0, most = 0;  // as read, both infinite where the sensor met nothing
  };
  /// The depths in the cell of a direction (tangents x/z, y/z as the pixels say) and in its neighbours; nothing where
  /// not all of them are known.
  [[nodiscard]] std::optional<Range> around(const Eigen::Vector2d& tangent) const;

 private:
  void resize(int columns, int rows);
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  /// Spreads the depths of every cell to its neighbours.
  void spread();

  Eigen::Vector2d first_{0, 0}, cell_{1, 1};  // tangents of the corner, and of a cell
  int columns_ = 0, rows_ = 0;
  std::vector<float> least_, most_;  // 0 unknown
};

}  // namespace vantage
