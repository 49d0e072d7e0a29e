#pragma once

#include "vantage/core/random.hpp"
#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// What a sensor would have measured instead of the noise-free image. In this order: pixels drop out with the
/// incidence; pixels at edges take the surface beside them (lateral noise); some of them mix both surfaces; depths
/// scatter, are rounded and, beyond the camera's limits, become unknown; any pixel may drop out. No-returns and unknown
/// pixels stay as they are but for the lateral noise. Incidence comes from the image's own normals; a pixel without one
/// counts as seen frontally and does not drop out by it. Draws in the order of the pixels: one seed, one image.
[[nodiscard]] RangeImage noisy(RangeImage image, const SensorModel& sensor, Random& random);

}  // namespace vantage
