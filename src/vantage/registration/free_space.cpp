#include "vantage/registration/free_space.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

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
double middle_depth(const RangeImage& image) {
  std::vector<float> depths;
  std::copy_if(image.depth.begin(), image.depth.end(), std::back_inserter(depths), RangeImage::is_hit);
  if (depths.empty()) return static_cast<double>(RangeImage::no_return);
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

}  // namespace

FreeSpace::FreeSpace(const RangeImage& image, double margin)
    : rays_(image.camera.rays()),
      min_depth_(image.camera.min_depth),
      max_depth_(image.camera.max_depth),
      margin_(margin),
      nearest_(image.depth) {
  require(margin > 0, "free space: margin = ", margin, " m: must be positive");
  const auto [columns, rows] = image.camera.resolution;
  const double depth = middle_depth(image);
  const auto radius = [&](double half, int count) {
    return static_cast<int>(std::min<double>(count, std::ceil(margin * count / (2 * half * depth))));
  };
  const auto width = static_cast<std::size_t>(columns);
  for (int row = 0; row < rows; ++row) {
    least_around(nearest_, static_cast<std::size_t>(row) * width, 1, columns, radius(rays_.x_half, columns));
  }
  for (int column = 0; column < columns; ++column) {
    least_around(nearest_, static_cast<std::size_t>(column), width, rows, radius(rays_.y_half, rows));
  }
}

bool FreeSpace::contains(const Vec3& point_in_sensor) const {
  const double depth = point_in_sensor.z();
  if (depth <= min_depth_ || depth >= max_depth_) return false;
  const auto [columns, rows] = rays_.resolution;
  const double column = (((point_in_sensor.x() / depth - rays_.x_middle) / rays_.x_half + 1) * columns - 1) / 2;
  const double row = (((point_in_sensor.y() / depth - rays_.y_middle) / rays_.y_half + 1) * rows - 1) / 2;
  if (!(column > -0.5 && column < columns - 0.5 && row > -0.5 && row < rows - 0.5)) return false;
  const auto pixel = static_cast<std::size_t>(std::lround(row)) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(std::lround(column));
  return depth + margin_ < static_cast<double>(nearest_[pixel]);
}

double FreeSpace::share_inside(std::span<const Vec3> points, const Pose& world_from_sensor) const {
  if (points.empty()) return 0;
  const Pose sensor_from_world = world_from_sensor.inverse();
  const auto inside = std::count_if(points.begin(), points.end(),
                                    [&](const Vec3& point) { return contains(sensor_from_world * point); });
  return static_cast<double>(inside) / static_cast<double>(points.size());
}

}  // namespace vantage
