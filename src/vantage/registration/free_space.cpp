#include "vantage/registration/free_space.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"

namespace vantage {
namespace {

/// Least value within `radius` places to either side, over `count` values that lie `stride` apart.
void least_around(std::vector<float>& values, std::size_t first, std::size_t stride, int count, int radius) {
  std::vector<float> line(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = values[first + i * stride];
  for (int i = 0; i < count; ++i) {
    const auto from = line.begin() + std::max(0, i - radius);
    const auto to = line.begin() + std::min(count, i + radius + 1);
    values[first + static_cast<std::size_t>(i) * stride] = *std::min_element(from, to);
  }
}

/// The median measured depth; infinity where nothing was measured.
double middle_depth(const std::vector<float>& depth) {
  std::vector<float> depths;
  std::copy_if(depth.begin(), depth.end(), std::back_inserter(depths), RangeImage::is_hit);
  if (depths.empty()) return static_cast<double>(RangeImage::no_return);
  return static_cast<double>(upper_median(std::move(depths)));
}

}  // namespace

FreeSpace::FreeSpace(const RangeImage& image, const SensorModel& sensor, double blur)
    : min_depth_(image.camera.min_depth), max_depth_(image.camera.max_depth), sensor_(sensor), blur_(blur) {
  require(blur >= 0, "free space: blur = ", blur, " m: must not be negative");
  const auto [columns, rows] = image.camera.resolution;
  constexpr int most = 160;
  const int block = (std::max(columns, rows) + most - 1) / most;
  // The camera of whole blocks: the last ones may reach beyond the image, where nothing is known.
  const Resolution reduced{(columns + block - 1) / block, (rows + block - 1) / block};
  rays_ = image.camera.rays();
  const double x_left = rays_.x_middle - rays_.x_half, y_top = rays_.y_middle - rays_.y_half;
  rays_.x_half *= static_cast<double>(reduced.columns * block) / columns;
  rays_.y_half *= static_cast<double>(reduced.rows * block) / rows;
  rays_.x_middle = x_left + rays_.x_half;
  rays_.y_middle = y_top + rays_.y_half;
  rays_.resolution = reduced;
  const auto size = static_cast<std::size_t>(reduced.rays());
  nearest_.assign(size, RangeImage::no_return);
  farthest_.assign(size, 0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto i = static_cast<std::size_t>(row / block) * static_cast<std::size_t>(reduced.columns) +
                     static_cast<std::size_t>(column / block);
      const float depth = image.at(column, row);
      nearest_[i] = std::min(nearest_[i], depth);
      if (RangeImage::is_hit(depth)) farthest_[i] = std::max(farthest_[i], depth);
    }
  }
  for (int row = 0; row < reduced.rows && columns % block != 0; ++row)
    nearest_[static_cast<std::size_t>((row + 1) * reduced.columns - 1)] = RangeImage::unknown;
  for (int column = 0; column < reduced.columns && rows % block != 0; ++column)
    nearest_[size - 1 - static_cast<std::size_t>(column)] = RangeImage::unknown;
  const double depth = middle_depth(image.depth);
  const auto radius = [&](double half, int count) {
    return static_cast<int>(std::clamp<double>(std::ceil(blur * count / (2 * half * depth)), 1, count));
  };
  const auto width = static_cast<std::size_t>(reduced.columns);
  for (int row = 0; row < reduced.rows; ++row) {
    least_around(nearest_, static_cast<std::size_t>(row) * width, 1, reduced.columns,
                 radius(rays_.x_half, reduced.columns));
  }
  for (int column = 0; column < reduced.columns; ++column) {
    least_around(nearest_, static_cast<std::size_t>(column), width, reduced.rows, radius(rays_.y_half, reduced.rows));
  }
}

FreeSpace::Answer FreeSpace::at(const Vec3& point_in_sensor) const {
  const double depth = point_in_sensor.z();
  if (depth <= min_depth_ || depth >= max_depth_) return Answer::unknown;
  const auto [columns, rows] = rays_.resolution;
  const double column = (((point_in_sensor.x() / depth - rays_.x_middle) / rays_.x_half + 1) * columns - 1) / 2;
  const double row = (((point_in_sensor.y() / depth - rays_.y_middle) / rays_.y_half + 1) * rows - 1) / 2;
  if (!(column > -0.5 && column < columns - 0.5 && row > -0.5 && row < rows - 0.5)) return Answer::unknown;
  const auto pixel = static_cast<std::size_t>(std::lround(row)) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(std::lround(column));
  const double margin = std::max(5 * sensor_.sigma(depth), blur_);
  if (depth + margin < static_cast<double>(nearest_[pixel])) return Answer::free;
  if (farthest_[pixel] > 0 && depth < static_cast<double>(farthest_[pixel]) + margin) return Answer::surface;
  return Answer::unknown;
}

}  // namespace vantage
