#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// Estimates how noisy a sensor is from its own images: the residuals of paraboloids (quadratic in 1/z) fitted to
/// windows of 7x7 hits. Where at least a tenth of the windows shows a smooth surface, the tenth with the least
/// residuals says how noisy all are: the 10 % quantile, set off against that of the chi-square distribution. Keeps
/// counts only, so that adding images one by one gives the same as adding them all.
class SensorEstimator {
 public:
  void add(const RangeImage& image);
  /// The deviation A + B z^2 that fits the windows best, beside the rounding to the least step between depths that was
  /// met; nothing where there are too few windows.
  [[nodiscard]] std::optional<SensorModel> estimate() const;
  [[nodiscard]] std::int64_t windows() const { return windows_; }

  static constexpr int side = 7;            // pixels
  static constexpr int least_windows = 30;  // per range of depths

 private:
  static constexpr int depth_bins = 64;
  static constexpr int sigma_bins = 512;
  using Histogram = std::array<std::int64_t, sigma_bins>;

  double quantum_ = std::numeric_limits<double>::infinity();  // the least step between neighbours, metres
  std::int64_t windows_ = 0;
  std::vector<Histogram> bins_ = std::vector<Histogram>(depth_bins);
};

}  // namespace vantage
