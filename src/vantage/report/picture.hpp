#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vantage {

/// An image of 8 bits per channel, row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height

  [[nodiscard]] std::array<std::uint8_t, 3> at(int x, int y) const {
    const std::size_t k =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[k], rgb[k + 1], rgb[k + 2]};
  }
  /// Throws InputError where the sizes are not positive or do not agree.
  void validate() const;
};

/// The picture as the bytes of a PNG file; the same bytes for the same picture.
[[nodiscard]] std::string png_bytes(const Picture& picture);

/// The picture as a `data:` address for the src of an <img>: a page that needs no other file.
[[nodiscard]] std::string png_data_uri(const Picture& picture);

}  // namespace vantage
