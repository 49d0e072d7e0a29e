#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/point_cloud_file.hpp"

namespace vantage {

/// A picture in sRGB, row by row: red, green, blue.
struct ColorImage {
  Resolution resolution{0, 0};
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// What is known of a frame of a recording before its pixels are read.
struct FrameInfo {
  std::string name;
  std::optional<double> time_s;           // of the recording's clock
  std::optional<Pose> world_from_sensor;  // as recorded, in the recording's unit; none where the recording has none
};

/// One frame of a recording: what a depth sensor measured from one pose.
struct Frame {
  FrameInfo info;
  /// A depth image as the sensor wrote it, or points in the sensor's frame.
  std::variant<DepthPixels, CloudFile> measured;
  /// Metres per unit of a depth image of whole numbers, where the recording says so; else the reader's options do.
  std::optional<double> metres_per_unit;
  std::optional<Intrinsics> intrinsics;  // of a depth image
  std::optional<ColorImage> color;       // seen from the same pose, of any resolution
  std::optional<Mask> mask;              // of the depth image's resolution
};

}  // namespace vantage
