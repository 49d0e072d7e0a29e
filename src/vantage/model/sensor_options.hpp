#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "vantage/map/evidence.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// What becomes of the pixels that no surface around them explains.
enum class FlyingPixelRule { remove, keep };

inline constexpr std::array<std::pair<FlyingPixelRule, const char*>, 2> flying_pixel_rules{
    {{FlyingPixelRule::remove, "remove"}, {FlyingPixelRule::keep, "keep"}}};
[[nodiscard]] inline const auto& names_of(FlyingPixelRule) { return flying_pixel_rules; }

/// How the sensor of real scans errs, and what is made of that.
struct SensorOptions {
  std::optional<std::string> sensor = std::nullopt;          // a preset
  std::optional<DepthDeviation> depth_noise = std::nullopt;  // instead of the preset's
  FlyingPixelRule flying_pixels = FlyingPixelRule::remove;
  MapRule map = MapRule::evidence;

  /// Throws InputError naming the option.
  void validate() const;
  /// Nothing where the options leave it to the scans.
  [[nodiscard]] std::optional<SensorModel> given() const;
};

template <class Field>
void describe(SensorOptions& o, Field&& field) {
  field("sensor", o.sensor, "",
        "how the sensor errs: " + names_of_sensors() +
            "; estimated from the scans if neither this nor depth-noise is given");
  field("depth-noise", o.depth_noise, "m, 1/m, m",
        "A,B or A,B,C: standard deviation of a depth z is A + B z^2 + C tan^2(incidence), instead of the sensor's");
  field("flying-pixels", o.flying_pixels, "",
        "pixels of depth images that no surface around them explains: remove (they become unknown) or keep");
  field("map", o.map, "",
        "how voxels become occupied: evidence (points against rays through them) or paper (by a point, for ever)");
}

}  // namespace vantage
