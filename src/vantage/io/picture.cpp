#include "vantage/io/picture.hpp"

#include <png.h>

#include "vantage/core/error.hpp"

namespace vantage {

void Picture::validate() const {
  require(width > 0 && height > 0, "picture of ", width, "x", height, " pixels: both sides must be positive");
  const std::size_t wanted = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  require(rgb.size() == wanted, "picture of ", width, "x", height, " pixels holds ", rgb.size(), " bytes: must hold ",
          wanted);
}

std::string png_bytes(const Picture& picture) {
  picture.validate();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0)
    throw Error(concat("cannot encode a picture of ", picture.width, "x", picture.height, " pixels: ", image.message));
  bytes.resize(size);
  return bytes;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (k < given ? static_cast<std::uint8_t>(bytes[i + k]) : std::uint8_t{0});
    for (std::size_t k = 0; k < 4; ++k) text += k <= given ? digits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string png_data_uri(const Picture& picture) { return "data:image/png;base64," + base64(png_bytes(picture)); }

}  // namespace vantage
