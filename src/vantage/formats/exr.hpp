#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vantage/formats/png16.hpp"

namespace vantage {

/// An image of one floating-point number per pixel, row by row.
struct FloatImage {
  Resolution resolution{0, 0};
  std::vector<float> values;
};

/// Whether the bytes begin as an OpenEXR file does.
[[nodiscard]] bool is_exr(std::string_view bytes);

/// One channel of an OpenEXR image: the only one, or else `Z` or `Y` (also as the last word of a layer's name). Scan
/// lines or tiles, of which the largest level is read, with ZIP, ZIPS, PIZ, PXR24, RLE or no compression; pixels of 16
/// or 32 bits. Throws InputError with `name` where the bytes are something else, damaged, cut off, larger than 16384
/// pixels on a side, or have more than `most_pixels` (or channels of 64 bytes for each of them), which is asked before
/// memory is taken.
[[nodiscard]] FloatImage decode_exr(std::string_view bytes, const std::string& name,
                                    std::int64_t most_pixels = any_pixels);

}  // namespace vantage
