#pragma once

#include <optional>

#include "vantage/core/random.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// How a real depth camera falls short of the true depth z. Nothing by default.
struct DepthNoise {
  double a = 0;        // standard deviation a + b z^2: its constant part in metres
  double b = 0;        // and its growth with the square of the depth, in 1/metres
  double quantum = 0;  // step between depths that the sensor can tell apart, metres; 0: continuous
  /// Incidence, in radians, from which on pixels drop out; the share of lost pixels grows evenly from none here to all
  /// at 90 degrees. Incidence is the angle between the ray and the surface's normal.
  std::optional<double> dropout_from_incidence = std::nullopt;

  [[nodiscard]] bool is_none() const { return a == 0 && b == 0 && quantum == 0 && !dropout_from_incidence; }
  /// Throws InputError naming the field and its value.
  void validate() const;
};

/// The image with noise on its hits; no-returns and unknown pixels stay as they are. Lost pixels become unknown, so do
/// those whose noisy depth falls outside the camera's limits. Incidence comes from the image's own normals; pixels
/// without a normal are not lost.
[[nodiscard]] RangeImage noisy(RangeImage image, const DepthNoise& noise, Random& random);

}  // namespace vantage
