#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// A grey image of 16 bits, row by row.
struct Gray16 {
  Resolution resolution{0, 0};
  std::vector<std::uint16_t> values;
};

/// Whether the bytes begin as a PNG file does.
[[nodiscard]] bool is_png(std::string_view bytes);

/// Throws InputError with `name` where the bytes are no PNG, damaged or cut off, of another colour type or bit depth,
/// or larger than 16384 pixels on a side. Memory stays in proportion to the input, whatever the header promises.
[[nodiscard]] Gray16 decode_png16(std::string_view bytes, const std::string& name);

/// Which pixels of an image count: 0 or 1 per pixel, row by row.
using Mask = std::vector<std::uint8_t>;

/// A PNG of any colour type and depth as a mask: black pixels (also of a palette; alpha plays no part) do not count.
/// Throws InputError as decode_png16() does, and where it has another size than the depth image, which is `resolution`.
[[nodiscard]] Mask decode_png_mask(std::string_view bytes, Resolution resolution, const std::string& name);

[[nodiscard]] std::string encode_png16(const Gray16& image);

}  // namespace vantage
