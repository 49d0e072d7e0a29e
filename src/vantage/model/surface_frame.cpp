#include "vantage/model/surface_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr int largest_radius = 6;            // of a window, pixels
constexpr double wanted_slope_error = 0.1;   // of the fitted planes
constexpr double steepest = 6;               // depth per step across: beyond it neighbours are not one surface
constexpr double noise_reach = 3 * 1.41421;  // how many sigma two depths of the same surface may differ
constexpr double least_cosine = 0.1;
constexpr double cosine_without_normal = 0.25;

double step_between_pixels(const RayGrid& rays) { return 2 * rays.x_half / rays.resolution.columns; }

/// How far each pixel is from where the surface jumps or is not known, in pixels (chessboard distance), up to the
/// largest radius + 1. A pixel beside a jump has 1: the window may reach it, but no farther.
class RoomAround {
 public:
  RoomAround(const RangeImage& image, const SensorModel& sensor)
      : columns_(image.camera.resolution.columns), rows_(image.camera.resolution.rows), room_(image.depth.size()) {
    mark_jumps(image, sensor);
    spread();
  }
  /// The largest window around the pixel that stays on its surface and in the image.
  [[nodiscard]] int radius(int column, int row) const {
    const int in_image = std::min(std::min(column, columns_ - 1 - column), std::min(row, rows_ - 1 - row));
    return std::min(in_image, room_[at(column, row)] - 1);
  }

 private:
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  void mark_jumps(const RangeImage& image, const SensorModel& sensor) {
    const RayGrid rays = image.camera.rays();
    const auto step = static_cast<float>(steepest * step_between_pixels(rays));
    const auto jumps = [&](float z, float other) {
      const float slope = step * std::min(z, other), difference = std::abs(z - other);
      return difference > slope &&
             difference > slope + static_cast<float>(noise_reach * sensor.sigma(static_cast<double>(z)));
    };
    std::fill(room_.begin(), room_.end(), static_cast<std::uint8_t>(largest_radius + 1));
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const std::size_t here = at(column, row);
        const float z = image.depth[here];
        if (!RangeImage::is_hit(z)) {
          room_[here] = 0;
          continue;
        }
        for (const std::size_t next : {column + 1 < columns_ ? here + 1 : here,
                                       row + 1 < rows_ ? here + static_cast<std::size_t>(columns_) : here}) {
          const float other = image.depth[next];
          if (next == here || !RangeImage::is_hit(other) || !jumps(z, other)) continue;
          room_[here] = std::min<std::uint8_t>(room_[here], 1);
          room_[next] = std::min<std::uint8_t>(room_[next], 1);
        }
      }
    }
  }

  /// Chessboard distance transform in two passes.
  void spread() {
    const auto lower = [&](std::size_t here, std::size_t other) {
      room_[here] = std::min<std::uint8_t>(room_[here], static_cast<std::uint8_t>(room_[other] + 1));
    };
    const auto width = static_cast<std::size_t>(columns_);
    for (int row = 1; row < rows_; ++row) {
      for (int column = 1; column + 1 < columns_; ++column) {
        const std::size_t here = at(column, row);
        for (const std::size_t other : {here - 1, here - width - 1, here - width, here - width + 1}) lower(here, other);
      }
    }
    for (int row = rows_ - 2; row >= 0; --row) {
      for (int column = columns_ - 2; column >= 1; --column) {
        const std::size_t here = at(column, row);
        for (const std::size_t other : {here + 1, here + width + 1, here + width, here + width - 1}) lower(here, other);
      }
    }
  }

  int columns_, rows_;
  std::vector<std::uint8_t> room_;
};

/// Sum of the squared offsets along one axis over a window.
constexpr double squares_of_window(int radius) {
  const double side = 2 * radius + 1;
  return side * side * radius * (radius + 1) / 3;
}

/// Sums of the inverse depth and of its moments over windows of pixels. A plane's inverse depth is linear in the pixel.
class WindowSums {
 public:
  struct Plane {
    double along_columns, along_rows, middle;  // of the inverse depth, per pixel and at the window's middle
  };

  explicit WindowSums(const RangeImage& image)
      : width_(static_cast<std::size_t>(image.camera.resolution.columns) + 1),
        sums_(width_ * (static_cast<std::size_t>(image.camera.resolution.rows) + 1), Sums{}) {
    const int columns = image.camera.resolution.columns;
    for (int row = 0; row < image.camera.resolution.rows; ++row) {
      Sums of_row{};
      const std::size_t above = static_cast<std::size_t>(row) * width_;
      for (int column = 0; column < columns; ++column) {
        const float z = image.at(column, row);
        const double inverse = RangeImage::is_hit(z) ? 1.0 / static_cast<double>(z) : 0;
        of_row[0] += inverse;
        of_row[1] += inverse * column;
        of_row[2] += inverse * row;
        const std::size_t here = above + static_cast<std::size_t>(column) + 1;
        for (std::size_t k = 0; k < 3; ++k) sums_[here + width_][k] = sums_[here][k] + of_row[k];
      }
    }
  }

  /// The plane of least squares through a full window.
  [[nodiscard]] Plane plane(int column, int row, int radius) const {
    const auto left = static_cast<std::size_t>(column - radius), right = static_cast<std::size_t>(column + radius + 1);
    const auto top = static_cast<std::size_t>(row - radius) * width_;
    const auto bottom = static_cast<std::size_t>(row + radius + 1) * width_;
    Sums sum;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] = sums_[bottom + right][k] - sums_[bottom + left][k] - sums_[top + right][k] + sums_[top + left][k];
    }
    const double side = 2 * radius + 1;
    const double squares = squares_of_window(radius);
    return {(sum[1] - column * sum[0]) / squares, (sum[2] - row * sum[0]) / squares, sum[0] / (side * side)};
  }

 private:
  using Sums = std::array<double, 3>;
  std::size_t width_;
  std::vector<Sums> sums_;  // of all pixels above and to the left
};

/// The window whose plane has the wanted error where pixels are this far apart.
int radius_for(double sigma, double spacing) {
  const double needed = sigma / (wanted_slope_error * spacing);
  int radius = 1;
  while (radius < largest_radius && squares_of_window(radius) < needed * needed) ++radius;
  return radius;
}

/// The normals of a range image's surfaces.
class PlaneFinder {
 public:
  PlaneFinder(const RangeImage& image, const SensorModel& sensor)
      : image_(image),
        sensor_(sensor),
        rays_(image.camera.rays()),
        room_(image, sensor),
        sums_(image),
        x_step_(step_between_pixels(rays_)),
        y_step_(2 * rays_.y_half / rays_.resolution.rows) {}

  /// Facing the sensor; zero where the pixel and its neighbours on the same surface have no room for a window.
  [[nodiscard]] Vec3 normal(int column, int row) const {
    const auto z = static_cast<double>(image_.at(column, row));
    const int wanted = radius_for(sensor_.sigma(z), x_step_ * z);
    const int radius = std::min(room_.radius(column, row), wanted);
    if (radius > 0) return normal_of(column, row, radius);
    // Beside a jump: the plane of the neighbour with the smallest step, if that is one of the same surface.
    double least_step = 2 * steepest * x_step_ * z + noise_reach * sensor_.sigma(z);
    Vec3 normal = Vec3::Zero();
    for (int v = std::max(1, row - 1); v <= std::min(row + 1, rays_.resolution.rows - 2); ++v) {
      for (int u = std::max(1, column - 1); u <= std::min(column + 1, rays_.resolution.columns - 2); ++u) {
        const int room = std::min(room_.radius(u, v), wanted);
        const double step = std::abs(static_cast<double>(image_.at(u, v)) - z);
        if (room < 1 || step >= least_step) continue;
        least_step = step;
        normal = normal_of(u, v, room);
      }
    }
    return normal;
  }

 private:
  [[nodiscard]] Vec3 normal_of(int column, int row, int radius) const {
    const WindowSums::Plane plane = sums_.plane(column, row, radius);
    const double x = plane.along_columns / x_step_, y = plane.along_rows / y_step_;
    return -Vec3(x, y, plane.middle - x * rays_.x(column) - y * rays_.y(row)).normalized();
  }

  const RangeImage& image_;
  const SensorModel& sensor_;
  RayGrid rays_;
  RoomAround room_;
  WindowSums sums_;
  double x_step_, y_step_;
};

}  // namespace

SurfaceFrame::SurfaceFrame(const RangeImage& image, const SurfaceNoise& noise)
    : rays_(image.camera.rays()),
      min_depth_(image.camera.min_depth),
      max_depth_(image.camera.max_depth),
      pixels_(image.depth.size()) {
  find_planes(image, noise);
  find_nearest();
}

void SurfaceFrame::find_planes(const RangeImage& image, const SurfaceNoise& noise) {
  const PlaneFinder planes(image, noise.sensor);
  const int columns = rays_.resolution.columns;
  parallel_for(static_cast<std::size_t>(rays_.resolution.rows), [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < columns; ++column) {
      SurfacePixel& pixel = pixels_[r * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
      pixel.depth = image.at(column, row);
      if (!RangeImage::is_hit(pixel.depth)) continue;
      const Vec3 ray = Vec3(rays_.x(column), rays_.y(row), 1).normalized();
      Vec3 normal = planes.normal(column, row);
      double cosine = -normal.dot(ray);
      const bool has_plane = cosine > 0;
      if (!has_plane) {  // no plane, or one that the sensor would see from behind
        normal = -ray;
        cosine = cosine_without_normal;
      }
      const double sigma = noise.sigma(static_cast<double>(pixel.depth), cosine);
      pixel.sigma = static_cast<float>(sigma);
      pixel.normal = normal.cast<float>();
      // Beside a jump a pixel says how far free space reaches, and nothing about the direction of a surface.
      pixel.weight = has_plane ? static_cast<float>(std::max(cosine, least_cosine) / (sigma * sigma)) : 0;
    }
  });
}

void SurfaceFrame::find_nearest() {
  const auto columns = static_cast<std::size_t>(rays_.resolution.columns);
  const auto rows = static_cast<std::size_t>(rays_.resolution.rows);
  const auto surface = [](float depth) { return depth == RangeImage::unknown ? RangeImage::no_return : depth; };
  std::vector<float> along_row(pixels_.size());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t here = row * columns + column;
      float least = surface(pixels_[here].depth);
      if (column > 0) least = std::min(least, surface(pixels_[here - 1].depth));
      if (column + 1 < columns) least = std::min(least, surface(pixels_[here + 1].depth));
      along_row[here] = least;
    }
  }
  for (std::size_t here = 0; here < pixels_.size(); ++here) {
    float least = along_row[here];
    if (here >= columns) least = std::min(least, along_row[here - columns]);
    if (here + columns < pixels_.size()) least = std::min(least, along_row[here + columns]);
    pixels_[here].nearest = least;
  }
}

std::optional<double> pixel_spacing(const RangeImage& image, const View& view, const Box3& box) {
  const RayGrid rays = image.camera.rays();
  std::vector<double> depths;
  for (int row = 0; row < rays.resolution.rows; ++row) {
    for (int column = 0; column < rays.resolution.columns; ++column) {
      const float z = image.at(column, row);
      if (!RangeImage::is_hit(z)) continue;
      const Vec3 point = point_in_sensor(rays, column, row, static_cast<double>(z));
      if (box.contains(view.world_from_sensor * point)) depths.push_back(static_cast<double>(z));
    }
  }
  if (depths.empty()) return std::nullopt;
  return upper_median(std::move(depths)) * step_between_pixels(rays);
}

}  // namespace vantage
