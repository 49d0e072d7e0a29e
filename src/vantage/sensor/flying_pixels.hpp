#pragma once

#include <cstdint>
#include <vector>

#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// At a depth edge many sensors measure something between the two surfaces: "flying" or "mixed" pixels.
struct FlyingPixelOptions {
  /// Share of the comparisons on a smooth surface that noise alone makes fail.
  double false_positive_rate = 0.001;
  /// A surface may rise by this many of a pixel's own footprints from one pixel to the next; beyond it is another one.
  /// Of surfaces turned at random 1/(1 + 12^2) = 0.7 % of what is seen is steeper.
  double max_step_in_footprints = 12;

  void validate() const;
};

/// One flag per pixel: 1 for hits that no surface around them explains.
///
/// Three pixels in a row, column or diagonal lie on one surface where neither step is a jump and the two steps differ
/// by no more than noise, the footprint of a pixel, or (steps of one sign) the smaller one of them: a surface of which
/// a pixel resolves the curvature. A hit is explained where it lies on one surface along two lines. Where only one line
/// explains it, it may be a wire, which nothing beside it hides, or a sheet of mixed pixels, which is seen beside the
/// nearer surface that it mixes: so it counts as flying where a hit within two pixels beside that line is nearer. Where
/// none does, it is flying. A hit with no two others beside it in any line cannot be judged and is left alone.
[[nodiscard]] std::vector<std::uint8_t> flying_pixels(const RangeImage& image, const SensorModel& sensor,
                                                      const FlyingPixelOptions& options = {});

struct CleanImage {
  RangeImage image;
  std::int64_t flying = 0;  // pixels that became unknown
  std::int64_t hits = 0;    // pixels that were hits before
};

/// The image with its flying pixels unknown.
[[nodiscard]] CleanImage without_flying_pixels(RangeImage image, const SensorModel& sensor,
                                               const FlyingPixelOptions& options = {});

}  // namespace vantage
