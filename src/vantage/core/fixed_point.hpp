#pragma once

#include <cmath>
#include <cstdint>

namespace vantage {

/// Sums of cosines run in 64-bit fixed point with 30 fractional bits: any order of adding gives the same bits.
[[nodiscard]] inline std::int64_t to_fixed_point(double value) { return std::llrint(value * 0x1p30); }
[[nodiscard]] inline double from_fixed_point(std::int64_t value) { return static_cast<double>(value) * 0x1p-30; }

}  // namespace vantage
