#include "vantage/registration/scan_surface.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr double least_grazing_cosine = 0.17;  // 80 degrees: beyond, a pixel mixes what lies before and behind

/// Depths of an image with the tangents of its rays.
class DepthWindow {
 public:
  DepthWindow(const RangeImage& image, const SensorModel& sensor, int half_width, double shared_error)
      : image_(image), sensor_(sensor), half_width_(half_width), shared_error_(shared_error) {
    const RayGrid rays = image.camera.rays();
    for (int column = 0; column < rays.resolution.columns; ++column) x_.push_back(rays.x(column));
    for (int row = 0; row < rays.resolution.rows; ++row) y_.push_back(rays.y(row));
  }

  /// The plane through the neighbourhood of a pixel that is a hit; nothing where the neighbours show no surface.
  [[nodiscard]] std::optional<SurfaceSample> sample(int column, int row) const {
    const auto depth = static_cast<double>(image_.at(column, row));
    const double pitch = x_.size() > 1 ? (x_[1] - x_[0]) * depth : 0;
    constexpr double steepest = 3.7;  // tangent of 75 degrees
    const double noise = sensor_.sigma(depth);
    Regression fit;
    // First all that may be the same surface, then what lies on the plane that these show.
    double gate = 4.3 * noise + steepest * half_width_ * pitch;
    for (int pass = 0; pass < 2; ++pass) {
      const Regression before = fit;
      fit = regress(column, row, pass == 0 ? std::nullopt : std::optional(before), gate, 1 / depth);
      const int side = 2 * half_width_ + 1;
      if (fit.count < std::max(5, side * side / 2) || !(fit.plane[2] > 0)) return std::nullopt;
      gate = 3 * std::max(noise, depth * depth * fit.deviation);
    }
    const Vec3 ray(x_[static_cast<std::size_t>(column)], y_[static_cast<std::size_t>(row)], 1);
    SurfaceSample result;
    result.normal =
        -Vec3(fit.plane[0], fit.plane[1], fit.plane[2] - fit.plane[0] * ray.x() - fit.plane[1] * ray.y()).normalized();
    result.point = ray / fit.plane[2];
    if (std::abs(result.point.z() - depth) > 3 * std::max(noise, depth * depth * fit.deviation)) return std::nullopt;
    const double across = std::abs(result.normal.dot(ray));
    if (across < least_grazing_cosine * ray.norm()) return std::nullopt;
    const double deviation = std::max(noise, depth * depth * fit.deviation);
    result.sigma = across * deviation * std::max(1 / std::sqrt(fit.count), shared_error_);
    return result;
  }

 private:
  /// 1/z = plane . (x - x0, y - y0, 1): planes are linear in the inverse depth.
  struct Regression {
    Vec3 plane = Vec3::Zero();
    double deviation = 0;  // of the inverse depths from the plane, 1/m
    int count = 0;
  };

  [[nodiscard]] Regression regress(int column, int row, const std::optional<Regression>& expected, double gate,
                                   double inverse) const {
    const auto [columns, rows] = image_.camera.resolution;
    const double x0 = x_[static_cast<std::size_t>(column)], y0 = y_[static_cast<std::size_t>(row)];
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, sq = 0, sxq = 0, syq = 0, sqq = 0;
    for (int r = std::max(0, row - half_width_); r <= std::min(rows - 1, row + half_width_); ++r) {
      for (int c = std::max(0, column - half_width_); c <= std::min(columns - 1, column + half_width_); ++c) {
        const float value = image_.at(c, r);
        if (!RangeImage::is_hit(value)) continue;
        const auto depth = static_cast<double>(value);
        const double x = x_[static_cast<std::size_t>(c)] - x0, y = y_[static_cast<std::size_t>(r)] - y0;
        const double plane_inverse =
            expected ? expected->plane[0] * x + expected->plane[1] * y + expected->plane[2] : inverse;
        if (!(std::abs(1 - depth * plane_inverse) * depth <= gate)) continue;
        const double q = 1 / depth - inverse;
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
        sq += q, sxq += x * q, syq += y * q, sqq += q * q;
      }
    }
    Regression fit;
    fit.count = static_cast<int>(n);
    if (fit.count < 5) return fit;
    Mat3 matrix;
    matrix << sxx, sxy, sx, sxy, syy, sy, sx, sy, n;
    const Vec3 side(sxq, syq, sq);
    const Vec3 solution = matrix.ldlt().solve(side);
    if (!solution.allFinite()) return {};
    fit.deviation = std::sqrt(std::max(0.0, (sqq - solution.dot(side)) / std::max(1.0, n - 3)));
    fit.plane = solution + Vec3(0, 0, inverse);
    return fit;
  }

  const RangeImage& image_;
  SensorModel sensor_;
  int half_width_;
  double shared_error_;
  std::vector<double> x_, y_;
};

struct ImageScale {
  std::size_t hits = 0;
  double depth = 0;    // median, metres
  double spacing = 0;  // between pixels there, metres
};

ImageScale scale_of(const RangeImage& image) {
  std::vector<float> depths;
  depths.reserve(image.depth.size());
  std::copy_if(image.depth.begin(), image.depth.end(), std::back_inserter(depths), RangeImage::is_hit);
  if (depths.empty()) return {};
  const std::size_t hits = depths.size();
  const RayGrid rays = image.camera.rays();
  const double pixel = 2 * std::max(rays.x_half / rays.resolution.columns, rays.y_half / rays.resolution.rows);
  const auto depth = static_cast<double>(upper_median(std::move(depths)));
  return {hits, depth, pixel * depth};
}

}  // namespace

double distance_between(std::span<const SurfaceSample> samples, const Pose& a, const Pose& b, std::size_t most) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); i += samples.size() / most + 1, ++count)
    squares += (a * samples[i].point - b * samples[i].point).squaredNorm();
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
}

void ScanSurfaceOptions::validate() const {
  require(max_samples >= 100, "max_samples = ", max_samples, ": must be at least 100");
  require(normal_sigma > 0 && normal_sigma < 1, "normal_sigma = ", normal_sigma, " rad: must be in (0, 1)");
  require(shared_error >= 0 && shared_error <= 1, "shared_error = ", shared_error, ": must be in [0, 1]");
}

double neighborhood_side(double sigma, double spacing, double normal_sigma) {
  return std::sqrt(std::sqrt(12.0) * sigma * spacing / normal_sigma);
}

ScanSurface scan_surface(const RangeImage& image, const std::optional<SensorModel>& given,
                         const ScanSurfaceOptions& options) {
  options.validate();
  const SensorModel sensor = given.value_or(usual_sensor);
  sensor.validate();
  ScanSurface surface;
  const ImageScale scale = scale_of(image);
  surface.sigma = sensor.sigma(scale.depth);
  if (scale.hits == 0) return surface;
  const double side = neighborhood_side(surface.sigma, scale.spacing, options.normal_sigma);
  const double stride_of_budget = std::sqrt(static_cast<double>(scale.hits) / options.max_samples);
  const int stride = std::max(
      {1, static_cast<int>(std::lround(side / (2 * scale.spacing))), static_cast<int>(std::ceil(stride_of_budget))});
  const int half_width = std::max(1, std::min(stride, 12));
  surface.spacing = stride * scale.spacing;

  const DepthWindow window(image, sensor, half_width, options.shared_error);
  const auto [columns, rows] = image.camera.resolution;
  std::vector<std::vector<SurfaceSample>> lines(static_cast<std::size_t>((rows + stride - 1) / stride));
  parallel_for(lines.size(), [&](std::size_t line) {
    const int row = static_cast<int>(line) * stride;
    for (int column = 0; column < columns; column += stride) {
      if (!RangeImage::is_hit(image.at(column, row))) continue;
      if (const auto sample = window.sample(column, row)) lines[line].push_back(*sample);
    }
  });
  for (const auto& line : lines) surface.samples.insert(surface.samples.end(), line.begin(), line.end());
  surface.free_space.emplace(image, sensor, surface.spacing);
  return surface;
}

}  // namespace vantage
