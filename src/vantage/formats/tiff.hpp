#pragma once

#include <string>
#include <string_view>

#include "vantage/formats/depth_image.hpp"

namespace vantage {

/// Whether the bytes begin as a TIFF file does, of either byte order, also of more than 4 GB.
[[nodiscard]] bool is_tiff(std::string_view bytes);

/// The only image of a TIFF file: one channel of whole numbers that fit into 16 bits, or of floats of 16, 32 or 64
/// bits; strips or tiles without compression or packed without loss. Throws InputError with `name` where the bytes are
/// something else, damaged, cut off, larger than 16384 pixels on a side, or have more than `most_pixels`, which is
/// asked before memory is taken.
[[nodiscard]] DepthPixels decode_tiff(std::string_view bytes, const std::string& name,
                                      std::int64_t most_pixels = any_pixels);

}  // namespace vantage
