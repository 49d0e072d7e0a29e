#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace vantage {

/// The value of a floating-point number of 16 bits (IEEE 754).
[[nodiscard]] inline float half_as_float(std::uint16_t bits) {
  const int exponent = bits >> 10U & 0x1f, fraction = bits & 0x3ff;
  const float sign = (bits & 0x8000U) != 0 ? -1.0F : 1.0F;
  if (exponent == 31)
    return fraction != 0 ? std::numeric_limits<float>::quiet_NaN() : sign * std::numeric_limits<float>::infinity();
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(fraction), -24);
  return sign * std::ldexp(static_cast<float>(1024 + fraction), exponent - 25);
}

}  // namespace vantage
