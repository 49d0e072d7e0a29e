#include "vantage/report/color.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {

std::string css(const Color& value) {
  const auto byte = [](double channel) { return static_cast<int>(std::lround(std::clamp(channel, 0.0, 1.0) * 255)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(value.red), byte(value.green), byte(value.blue));
}

Color mix(const Color& a, const Color& b, double share) {
  return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share, a.blue + (b.blue - a.blue) * share};
}

Color sequential_color(double share) {
  if (std::isnan(share)) return palette::no_value;
  // Every ninth of the viridis scale.
  constexpr std::array<Color, 10> stops{color(0x440154), color(0x482878), color(0x3E4989), color(0x31688E),
                                        color(0x26828E), color(0x1F9E89), color(0x35B779), color(0x6ECE58),
                                        color(0xB5DE2B), color(0xFDE725)};
  const double place = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  return mix(stops[below], stops[below + 1], place - static_cast<double>(below));
}

}  // namespace vantage
