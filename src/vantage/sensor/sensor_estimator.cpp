#include "vantage/sensor/sensor_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace vantage {
namespace {

constexpr int half = SensorEstimator::side / 2;
constexpr double pixels = SensorEstimator::side * SensorEstimator::side;
constexpr double degrees_of_freedom = pixels - 6;
constexpr double share = 0.1;
constexpr double mean_square = half * (half + 1) / 3.0;  // of a column's offset from the centre: 4
static_assert(SensorEstimator::side == 7, "the sums of squares in fit() are those of 7x7 windows");
/// The 10 % quantile of chi-square with 43 degrees of freedom over their number (Wilson and Hilferty's cube).
const double quantile_of_mean_square =
    std::pow(1 - 2 / (9 * degrees_of_freedom) - 1.2815515655446004 * std::sqrt(2 / (9 * degrees_of_freedom)), 3);

// Logarithmic bins: depths from 5 cm in steps of 12 %, deviations from a micrometre in steps of 3 %.
constexpr double least_depth = 0.05, depth_ratio = 1.12;
constexpr double least_sigma = 1e-6, sigma_ratio = 1.03;

int bin_of(double value, double least, double ratio, int bins) {
  if (!(value > least)) return 0;
  return std::min(static_cast<int>(std::log(value / least) / std::log(ratio)), bins - 1);
}
double middle_of(int bin, double least, double ratio) { return least * std::pow(ratio, bin + 0.5); }

struct Window {
  double depth;  // at its centre
  double sigma;  // of the residuals, metres
};

std::optional<Window> fit(const RangeImage& image, int column, int row) {
  const double center = static_cast<double>(image.at(column, row));
  if (!RangeImage::is_hit(image.at(column, row))) return std::nullopt;
  // 1/z less that of the centre, so that nothing cancels.
  double sum = 0, squares = 0, along_columns = 0, along_rows = 0;
  double bent_columns = 0, bent_rows = 0, twisted = 0;
  for (int v = -half; v <= half; ++v) {
    for (int u = -half; u <= half; ++u) {
      const float depth = image.at(column + u, row + v);
      if (!RangeImage::is_hit(depth)) return std::nullopt;
      const double z = static_cast<double>(depth);
      const double w = (center - z) / (z * center);
      sum += w;
      squares += w * w;
      along_columns += u * w;
      along_rows += v * w;
      bent_columns += (u * u - mean_square) * w;
      bent_rows += (v * v - mean_square) * w;
      twisted += u * v * w;
    }
  }
  // The functions 1, u, v, u^2 - 4, v^2 - 4 and u v are orthogonal over the window; these are their squares' sums.
  constexpr double moment = pixels * mean_square;
  constexpr double bent_moment = 588;
  constexpr double twisted_moment = pixels * mean_square * mean_square;
  const double explained = sum * sum / pixels + (along_columns * along_columns + along_rows * along_rows) / moment +
                           (bent_columns * bent_columns + bent_rows * bent_rows) / bent_moment +
                           twisted * twisted / twisted_moment;
  const double residual = std::max(0.0, squares - explained) / degrees_of_freedom;
  return Window{center, std::sqrt(residual) * center * center};
}

/// Sums of a weighted least-squares fit of a + b z^2.
struct NoiseFit {
  double weight = 0, x = 0, y = 0, xx = 0, xy = 0;

  void add(double depth, double sigma, double w) {
    const double square = depth * depth;
    weight += w;
    x += w * square;
    y += w * sigma;
    xx += w * square * square;
    xy += w * square * sigma;
  }
  /// Neither part negative.
  [[nodiscard]] SensorModel solve() const {
    const double determinant = weight * xx - x * x;
    if (determinant > 1e-9 * weight * xx) {
      const double b = (weight * xy - x * y) / determinant;
      const double a = (y - b * x) / weight;
      if (a >= 0 && b >= 0) return sensor_with({a, b});
      if (a < 0) return sensor_with({0, xy / xx});
    }
    return sensor_with({y / weight, 0});
  }
};

/// The deviation found at a depth.
struct NoiseAtDepth {
  double depth, sigma, windows;
};

/// Least absolute relative deviations, by least squares with weights from the fit before: a range of depths that shows
/// nothing but clutter does not count for much.
SensorModel fit_noise(std::span<const NoiseAtDepth> found) {
  constexpr int iterations = 20;
  constexpr double least_misfit = 0.05;  // relative; below it all ranges count alike
  std::vector<double> weights(found.size(), 1);
  SensorModel sensor;
  for (int i = 0; i < iterations; ++i) {
    NoiseFit fit;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double scale = std::max(found[k].sigma, least_sigma);
      fit.add(found[k].depth, found[k].sigma, found[k].windows * weights[k] / (scale * scale));
    }
    sensor = fit.solve();
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double scale = std::max(found[k].sigma, least_sigma);
      const double misfit = std::abs(sensor.noise(found[k].depth) - found[k].sigma) / scale;
      weights[k] = 1 / std::max(misfit, least_misfit);
    }
  }
  return sensor;
}

}  // namespace

void SensorEstimator::add(const RangeImage& image) {
  const auto [columns, rows] = image.camera.resolution;
  for (std::size_t i = 1; i < image.depth.size(); ++i) {
    const double step = std::abs(static_cast<double>(image.depth[i]) - static_cast<double>(image.depth[i - 1]));
    if (step > 0 && RangeImage::is_hit(image.depth[i]) && RangeImage::is_hit(image.depth[i - 1])) {
      quantum_ = std::min(quantum_, step);
    }
  }
  for (int row = half; row + half < rows; row += side) {
    for (int column = half; column + half < columns; column += side) {
      const std::optional<Window> window = fit(image, column, row);
      if (!window) continue;
      ++windows_;
      const int depth = bin_of(window->depth, least_depth, depth_ratio, depth_bins);
      ++bins_[static_cast<std::size_t>(depth)]
             [static_cast<std::size_t>(bin_of(window->sigma, least_sigma, sigma_ratio, sigma_bins))];
    }
  }
}

std::optional<SensorModel> SensorEstimator::estimate() const {
  const double quantum = std::isfinite(quantum_) ? quantum_ : 0;
  std::vector<NoiseAtDepth> found;
  for (int bin = 0; bin < depth_bins; ++bin) {
    const Histogram& counts = bins_[static_cast<std::size_t>(bin)];
    std::int64_t count = 0;
    for (const std::int64_t each : counts) count += each;
    if (count < least_windows) continue;
    std::int64_t below = 0;
    int sigma_bin = 0;
    const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count)));
    while ((below += counts[static_cast<std::size_t>(sigma_bin)]) < wanted) ++sigma_bin;
    const double residual = sigma_bin == 0 ? 0 : middle_of(sigma_bin, least_sigma, sigma_ratio);
    const double variance = residual * residual / quantile_of_mean_square - quantum * quantum / 12;
    found.push_back(
        {middle_of(bin, least_depth, depth_ratio), std::sqrt(std::max(0.0, variance)), static_cast<double>(count)});
  }
  if (found.empty()) return std::nullopt;
  SensorModel sensor = fit_noise(found);
  sensor.quantum = quantum;
  return sensor;
}

}  // namespace vantage
