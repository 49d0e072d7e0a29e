#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// An image of one floating-point number per pixel, row by row.
struct FloatImage {
  Resolution resolution{0, 0};
  std::vector<float> values;
};

/// Whether the bytes begin as an OpenEXR file does.
[[nodiscard]] bool is_exr(std::string_view bytes);

/// One channel of an OpenEXR image: the only one, or else `Z` or `Y` (also as the last word of a layer's name). Scan
/// lines without compression, RLE, ZIPS or ZIP; pixels of 16 or 32 bits. Throws InputError with `name` where the bytes
/// are something else, damaged, cut off, or larger than 16384 pixels on a side. Memory stays in proportion to the
/// input, whatever the header promises.
[[nodiscard]] FloatImage decode_exr(std::string_view bytes, const std::string& name);

}  // namespace vantage
