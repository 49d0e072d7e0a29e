#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vantage {

/// A colour in sRGB, each channel from 0 to 1.
struct Color {
  double red = 0, green = 0, blue = 0;

  bool operator==(const Color&) const = default;
};

/// 0xRRGGBB.
[[nodiscard]] constexpr Color color(std::uint32_t hex) {
  return {static_cast<double>((hex >> 16U) & 255U) / 255, static_cast<double>((hex >> 8U) & 255U) / 255,
          static_cast<double>(hex & 255U) / 255};
}
/// `#rrggbb`.
[[nodiscard]] std::string css(const Color& value);
/// a at share 0, b at share 1.
[[nodiscard]] Color mix(const Color& a, const Color& b, double share);

/// A scale from low to high that grows evenly in lightness, so that it reads without colour vision and in grey print
/// (viridis, van der Walt and Smith 2015). Arguments outside [0, 1] are clamped; NaN gives the grey of "no value".
[[nodiscard]] Color sequential_color(double share);

namespace palette {
// Okabe and Ito (2008): told apart by people with any kind of colour blindness.
inline constexpr Color black = color(0x000000), orange = color(0xE69F00), sky = color(0x56B4E9),
                       green = color(0x009E73), yellow = color(0xF0E442), blue = color(0x0072B2),
                       vermillion = color(0xD55E00), purple = color(0xCC79A7);
inline constexpr Color no_value = color(0xCDD1D6);
inline constexpr Color clay = color(0xE0D3C1);  // what models look like where nothing else is to be shown
}  // namespace palette

}  // namespace vantage
