#pragma once

#include <cstdint>
#include <limits>
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

/// For images that may be as large as their format allows.
inline constexpr std::int64_t any_pixels = std::numeric_limits<std::int64_t>::max();

/// Throws InputError with `name` where the bytes are no PNG, damaged or cut off, of another colour type or bit depth,
/// larger than 16384 pixels on a side, or have more than `most_pixels`, which is asked before memory is taken for them.
/// A file may unpack to a thousand times its size.
[[nodiscard]] Gray16 decode_png16(std::string_view bytes, const std::string& name,
                                  std::int64_t most_pixels = any_pixels);
/// Throws InputError where an image has more pixels than that.
void require_pixels(Resolution resolution, std::int64_t most_pixels, const std::string& name);

/// Which pixels of an image count: 0 or 1 per pixel, row by row.
using Mask = std::vector<std::uint8_t>;

/// A PNG of any colour type and depth as a mask: black pixels (also of a palette) do not count. Where some pixels are
/// transparent the mask lies in the alpha channel: those do not count, and colours play no part.
/// Throws InputError as decode_png16() does, and where it has another size than the depth image, which is `resolution`.
[[nodiscard]] Mask decode_png_mask(std::string_view bytes, Resolution resolution, const std::string& name);

/// The values of a grey PNG of 8 or 16 bits (fewer bits and palettes as 8), row by row; of the first channel where it
/// has several. Throws InputError as decode_png_mask() does.
[[nodiscard]] std::vector<std::uint16_t> decode_png_grey(std::string_view bytes, Resolution resolution,
                                                         const std::string& name);

[[nodiscard]] std::string encode_png16(const Gray16& image);

}  // namespace vantage
