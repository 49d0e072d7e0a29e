#include "vantage/report/picture.hpp"

#include <png.h>

#include "vantage/core/error.hpp"
#include "vantage/files/packed_array.hpp"

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

std::string png_data_uri(const Picture& picture) {
  const std::string bytes = png_bytes(picture);
  return "data:image/png;base64," + base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace vantage
