#pragma once

#include <string>
#include <string_view>

#include "vantage/formats/depth_image.hpp"

namespace vantage {

/// Whether the bytes begin as a NumPy array file (.npy) does, or a portable float map (.pfm).
[[nodiscard]] bool is_npy(std::string_view bytes);
[[nodiscard]] bool is_pfm(std::string_view bytes);

/// A NumPy array of rows x columns (one more axis of length 1 may come first or last): uint16 and other whole numbers
/// are units, float16, float32 and float64 are floats, of either byte order. Throws InputError with `name` for other
/// types and shapes, and where bytes are missing.
[[nodiscard]] DepthPixels decode_npy(std::string_view bytes, const std::string& name,
                                     std::int64_t most_pixels = any_pixels);

/// A grey portable float map (`Pf`), of either byte order; its rows run from the lowest to the highest. Throws
/// InputError with `name` where it is none, has colours, or is cut off.
[[nodiscard]] FloatImage decode_pfm(std::string_view bytes, const std::string& name,
                                    std::int64_t most_pixels = any_pixels);

}  // namespace vantage
