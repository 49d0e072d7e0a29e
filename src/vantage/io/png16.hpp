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

/// Throws InputError with `name` where the bytes are no PNG, damaged or cut off, of another colour type or bit depth,
/// or larger than 16384 pixels on a side. Memory stays in proportion to the input, whatever the header promises.
[[nodiscard]] Gray16 decode_png16(std::string_view bytes, const std::string& name);

[[nodiscard]] std::string encode_png16(const Gray16& image);

}  // namespace vantage
