#include "vantage/formats/depth_image.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

/// What a camera with these limits makes of a measured depth.
float within_limits(double depth, const RangeCamera& camera) {
  if (!(depth > 0) || depth < camera.min_depth) return RangeImage::unknown;
  return depth > camera.max_depth ? RangeImage::no_return : static_cast<float>(depth);
}

void check_resolution(Resolution image, Resolution camera, const std::string& name) {
  if (image == camera) return;
  throw InputError(
      fmt::format("{}: has {}x{} pixels, the camera {}x{}; do the intrinsics belong to another resolution?", name,
                  image.columns, image.rows, camera.columns, camera.rows));
}

FloatImage decode_raw(std::string_view bytes, Resolution resolution, const std::string& name) {
  const auto pixels = static_cast<std::size_t>(resolution.rays());
  if (bytes.size() != 4 * pixels) {
    throw InputError(fmt::format("{}: has {} bytes; {}x{} pixels of float32 are {}", name, bytes.size(),
                                 resolution.columns, resolution.rows, 4 * pixels));
  }
  FloatImage image{resolution, std::vector<float>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    std::uint32_t raw = 0;
    for (std::size_t k = 0; k < 4; ++k) raw |= std::uint32_t{static_cast<unsigned char>(bytes[4 * i + k])} << (8 * k);
    image.values[i] = std::bit_cast<float>(raw);
  }
  return image;
}

}  // namespace

void DepthEncoding::validate() const {
  require(std::isfinite(metres_per_unit) && metres_per_unit > 0, "depth scale = ", metres_per_unit,
          " m per unit: must be positive (0.001 for millimetres)");
  require(metres_per_unit <= 1, "depth scale = ", metres_per_unit,
          " m per unit: must be at most 1; it is metres per unit, not units per metre");
  require(std::isfinite(metres_per_float) && metres_per_float > 0, "unit = ", metres_per_float, " m: must be positive");
  require(!no_return || *no_return > 0, "no_return = 0: 0 already means unknown");
}

RangeImage range_image(const Gray16& image, const RangeCamera& camera, const DepthEncoding& encoding) {
  encoding.validate();
  camera.validate();
  check_resolution(image.resolution, camera.resolution, "depth image");
  RangeImage result{camera, std::vector<float>(image.values.size())};
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const std::uint16_t value = image.values[i];
    result.depth[i] =
        encoding.no_return == value ? RangeImage::no_return : within_limits(encoding.metres_per_unit * value, camera);
  }
  return result;
}

Gray16 depth_pixels(const RangeImage& image, const DepthEncoding& encoding) {
  encoding.validate();
  image.validate();
  constexpr double largest = std::numeric_limits<std::uint16_t>::max();
  Gray16 result{image.camera.resolution, std::vector<std::uint16_t>(image.depth.size())};
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const float depth = image.depth[i];
    if (RangeImage::is_hit(depth)) {
      // A point nearer than half a unit must not become "unknown".
      const double units = std::max(1.0, std::round(static_cast<double>(depth) / encoding.metres_per_unit));
      require(units <= largest && units != encoding.no_return, "depth ", depth,
              " m does not fit into 16 bits in units of ", encoding.metres_per_unit, " m; use a larger unit");
      result.values[i] = static_cast<std::uint16_t>(units);
    } else if (depth > 0) {
      result.values[i] = encoding.no_return.value_or(0);
    }
  }
  return result;
}

RangeImage parse_depth_png(std::string_view bytes, const RangeCamera& camera, const DepthEncoding& encoding,
                           const std::string& name) {
  const Gray16 image = decode_png16(bytes, name);
  check_resolution(image.resolution, camera.resolution, name);
  return range_image(image, camera, encoding);
}

RangeImage range_image(const FloatImage& image, const RangeCamera& camera, const DepthEncoding& encoding) {
  encoding.validate();
  camera.validate();
  check_resolution(image.resolution, camera.resolution, "depth image");
  RangeImage result{camera, std::vector<float>(image.values.size())};
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    result.depth[i] = within_limits(encoding.metres_per_float * static_cast<double>(image.values[i]), camera);
  }
  return result;
}

RangeImage masked(RangeImage image, const Mask& mask) {
  require(mask.size() == image.depth.size(), "mask: has ", mask.size(), " pixels, the depth image ", image.depth.size(),
          "; must have the same");
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) image.depth[i] = RangeImage::unknown;
  }
  return image;
}

DepthPixels decode_depth(std::string_view bytes, const std::optional<Resolution>& raw, const std::string& name,
                         std::int64_t most_pixels) {
  if (is_png(bytes)) return decode_png16(bytes, name, most_pixels);
  if (is_exr(bytes)) return decode_exr(bytes, name, most_pixels);
  require(raw.has_value(), name,
          ": the size of a raw image is not known; the intrinsics must have it (a .yaml or .json file)");
  require_pixels(*raw, most_pixels, name);
  return decode_raw(bytes, *raw, name);
}

RangeImage parse_depth_raw(std::string_view bytes, const RangeCamera& camera, const DepthEncoding& encoding,
                           const std::string& name) {
  return range_image(decode_raw(bytes, camera.resolution, name), camera, encoding);
}

RangeImage read_depth_image(const std::filesystem::path& path, const RangeCamera& camera,
                            const DepthEncoding& encoding) {
  const auto ending = path.extension();
  if (ending == ".png") return parse_depth_png(read_file(path), camera, encoding, path.string());
  if (ending == ".raw") return parse_depth_raw(read_file(path), camera, encoding, path.string());
  require(ending == ".exr", path.string(), ": a depth image must be a .png, .exr or .raw file");
  const FloatImage image = decode_exr(read_file(path), path.string());
  check_resolution(image.resolution, camera.resolution, path.string());
  return range_image(image, camera, encoding);
}

Resolution read_depth_resolution(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (path.extension() == ".exr") return decode_exr(bytes, path.string()).resolution;
  return decode_png16(bytes, path.string()).resolution;
}

void write_depth_png(const std::filesystem::path& path, const RangeImage& image, const DepthEncoding& encoding) {
  write_file_atomically(path, encode_png16(depth_pixels(image, encoding)));
}

}  // namespace vantage
