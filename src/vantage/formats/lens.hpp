#pragma once

#include <cstdint>
#include <vector>

#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/depth_image.hpp"

namespace vantage {

/// For each pixel of the image that a pinhole camera with the same fx, fy, cx and cy would have taken, row by row: the
/// nearest pixel of the distorted image, -1 where that lies outside, or beyond the radius at which the polynomial of
/// the lens turns back (there it says nothing of the lens).
[[nodiscard]] std::vector<std::int32_t> distorted_pixels(const Intrinsics& intrinsics, Resolution resolution);

/// The image that a pinhole camera without distortion would have taken, unknown (0) where nothing is known of it.
/// Returns the image as it is where there is no distortion.
[[nodiscard]] Gray16 undistorted(Gray16 image, const Intrinsics& intrinsics);
[[nodiscard]] FloatImage undistorted(FloatImage image, const Intrinsics& intrinsics);
[[nodiscard]] RangeImage undistorted(RangeImage image, const Intrinsics& intrinsics);

}  // namespace vantage
