#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// How a depth sensor errs. The simulation produces with it; registration and fusion weigh with it. Nothing by default.
/// Depths are along the viewing axis, metres; incidence is the angle between the ray and the surface's normal.
struct SensorModel {
  // Standard deviation of the random part of a depth z on a surface seen under the incidence t:
  //     constant + linear z + quadratic z^2 + incidence tan^2 t
  double constant = 0;   // metres
  double linear = 0;     // metres per metre; may be negative where the sum never is
  double quadratic = 0;  // 1/metre
  double incidence = 0;  // metres
  // Depths that the sensor can tell apart.
  double quantum = 0;            // depths are multiples of it, metres; 0: continuous
  double disparity_quantum = 0;  // 1/z is a multiple of it, 1/metre: a step of z^2 times it; 0: continuous
  /// Which of the surfaces at a depth edge a pixel measures is decided this far beside it: standard deviation, pixels.
  double lateral = 0;
  /// Share of the pixels next to a depth edge that measure something between the two surfaces ("flying" pixels).
  double mixed = 0;
  /// Share of all pixels that return nothing.
  double dropout = 0;
  /// Incidence, radians, from which on further pixels return nothing: none here, growing evenly to all at 90 degrees.
  std::optional<double> dropout_from_incidence = std::nullopt;

  /// Beyond this cosine (84 degrees) nobody has measured how sensors err; the deviation grows no further.
  static constexpr double least_cosine = 0.1;

  /// Standard deviation of the random part alone, metres.
  [[nodiscard]] double noise(double depth, double cosine = 1) const {
    const double squared = cosine * cosine;
    const double inverse = 1 / std::max(squared, least_cosine * least_cosine);
    return constant + linear * depth + quadratic * depth * depth + incidence * (inverse - 1);
  }
  /// The step between neighbouring depths that the sensor can tell apart, metres.
  [[nodiscard]] double step(double depth) const { return std::max(quantum, disparity_quantum * depth * depth); }
  /// Standard deviation of a single depth, rounding included, metres: what a measurement is weighed by.
  [[nodiscard]] double sigma(double depth, double cosine = 1) const {
    const double random = noise(depth, cosine);
    const double rounding = step(depth);
    return std::sqrt(random * random + rounding * rounding / 12);
  }
  /// The nearest depth that the sensor can tell; infinite where it is farther than all of them.
  [[nodiscard]] double quantised(double depth) const;
  /// Share of the pixels on a surface under this incidence (radians) that return nothing.
  [[nodiscard]] double dropout_at(double angle) const;

  [[nodiscard]] bool is_ideal() const;
  /// Throws InputError naming the field and its value.
  void validate() const;
  bool operator==(const SensorModel&) const = default;
};

/// The deviation a + b z^2 + c tan^2(incidence) of a depth z, metres: how people give it.
struct DepthDeviation {
  double a = 0;  // metres
  double b = 0;  // 1/metre
  double c = 0;  // metres

  [[nodiscard]] bool is_none() const { return a == 0 && b == 0 && c == 0; }
  /// Throws InputError that names the option depth-noise.
  void validate() const;
  bool operator==(const DepthDeviation&) const = default;
};

/// A sensor that errs so and in no other way.
[[nodiscard]] SensorModel sensor_with(const DepthDeviation& noise);
/// The same sensor with another deviation.
[[nodiscard]] SensorModel with_noise(SensorModel sensor, const DepthDeviation& noise);

/// Presets: ideal, primesense, realsense-d435, realsense-l515, azure-kinect, structured-light. docs/sensors.md says
/// where their figures come from.
[[nodiscard]] std::vector<std::string> sensor_names();
/// The same, separated by commas.
[[nodiscard]] std::string names_of_sensors();
/// Throws InputError that lists the names where there is no such preset.
[[nodiscard]] SensorModel sensor_by_name(std::string_view name);
/// What the model says, for people: "1.5 mm - 1.5 mm/m z + 1.9 mm/m2 z^2, ...".
[[nodiscard]] std::string description(const SensorModel& sensor);

}  // namespace vantage
