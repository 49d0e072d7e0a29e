#include "vantage/doctor/depth_map.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr int most_cells = 160;  // along a side: fine enough for outlines, few enough for hundreds of frames

}  // namespace

void DepthMap::resize(int columns, int rows) {
  columns_ = columns;
  rows_ = rows;
  least_.assign(at(0, rows), 0.0F);
  most_.assign(at(0, rows), 0.0F);
}

DepthMap::DepthMap(const RangeImage& image) {
  const Resolution size = image.camera.resolution;
  const int block = std::max(1, (std::max(size.columns, size.rows) + most_cells - 1) / most_cells);
  const RayGrid rays = image.camera.rays();
  first_ = {image.camera.left, image.camera.top};
  cell_ = block * Eigen::Vector2d(2 * rays.x_half / size.columns, 2 * rays.y_half / size.rows);
  resize(size.columns / block, size.rows / block);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      float least = RangeImage::no_return, most = 0;
      for (int v = row * block; v < (row + 1) * block; ++v) {
        for (int u = column * block; u < (column + 1) * block; ++u) {
          least = std::min(least, image.at(u, v));
          most = std::max(most, image.at(u, v));
        }
      }
      if (least <= 0) most = least = 0;
      least_[at(column, row)] = least;
      most_[at(column, row)] = most;
    }
  }
  spread();
}

DepthMap::DepthMap(const std::vector<Vec3>& points) {
  Eigen::AlignedBox2d extent;
  std::vector<Vec3> ahead;  // tangents and depth
  for (const Vec3& point : points) {
    if (point.z() <= 0) continue;
    ahead.emplace_back(point.x() / point.z(), point.y() / point.z(), point.z());
    extent.extend(ahead.back().head<2>());
  }
  if (ahead.size() < 16 || extent.volume() <= 0) return;
  cell_.setConstant(1.5 * std::sqrt(extent.volume() / static_cast<double>(ahead.size())));
  first_ = extent.min();
  const Eigen::Vector2d size = extent.sizes().cwiseQuotient(cell_);
  if (size.maxCoeff() > 4096) return;  // a few points far to the side would make it a map of nothing
  resize(static_cast<int>(size.x()) + 1, static_cast<int>(size.y()) + 1);
  for (const Vec3& each : ahead) {
    const Eigen::Vector2d place = (each.head<2>() - first_).cwiseQuotient(cell_);
    const std::size_t cell = at(static_cast<int>(place.x()), static_cast<int>(place.y()));
    const auto depth = static_cast<float>(each.z());
    least_[cell] = least_[cell] == 0 ? depth : std::min(least_[cell], depth);
    most_[cell] = std::max(most_[cell], depth);
  }
  spread();
}

void DepthMap::spread() {
  const std::vector<float> least = least_, most = most_;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      float low = RangeImage::no_return, high = 0;
      const bool is_border = row == 0 || column == 0 || row + 1 == rows_ || column + 1 == columns_;
      for (int dy = -1; !is_border && dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          low = std::min(low, least[at(column + dx, row + dy)]);
          high = std::max(high, most[at(column + dx, row + dy)]);
        }
      }
      const bool is_known = !is_border && low > 0;
      least_[at(column, row)] = is_known ? low : 0;
      most_[at(column, row)] = is_known ? high : 0;
    }
  }
}

std::optional<DepthMap::Range> DepthMap::around(const Eigen::Vector2d& tangent) const {
  if (columns_ == 0) return std::nullopt;
  const Eigen::Vector2d place = (tangent - first_).cwiseQuotient(cell_);
  if (!(place.minCoeff() >= 0) || !(place.x() < columns_) || !(place.y() < rows_)) return std::nullopt;
  const std::size_t cell = at(static_cast<int>(place.x()), static_cast<int>(place.y()));
  if (least_[cell] <= 0) return std::nullopt;
  return Range{static_cast<double>(least_[cell]), static_cast<double>(most_[cell])};
}

}  // namespace vantage
