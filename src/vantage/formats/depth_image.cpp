#include "vantage/formats/depth_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/float_images.hpp"
#include "vantage/formats/tiff.hpp"

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

/// Metres along the axis within the camera's limits; `metres` says what a value means.
template <class Value, class Metres>
RangeImage converted(const std::vector<Value>& values, const RangeCamera& camera, const DepthEncoding& encoding,
                     const Metres& metres) {
  encoding.validate();
  camera.validate();
  const RayGrid rays = camera.rays();
  const auto [columns, rows] = camera.resolution;
  const bool along_ray = encoding.along == DepthAlong::ray;
  RangeImage result{camera, std::vector<float>(values.size())};
  std::size_t pixel = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++pixel) {
      const Value value = values[pixel];
      if (encoding.unknown && static_cast<double>(value) == encoding.unknown->value) continue;
      double depth = metres(value);
      if (along_ray) depth /= std::hypot(rays.x(column), rays.y(row), 1.0);
      result.depth[pixel] = within_limits(depth, camera);
    }
  }
  return result;
}

template <class Image>
Image without_masked(Image image, const Mask& mask) {
  require(mask.size() == image.values.size(), "mask: has ", mask.size(), " pixels, the depth image ",
          image.values.size(), "; must have the same");
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) image.values[i] = 0;
  }
  return image;
}

bool is_depth_ending(std::string_view ending) {
  constexpr std::array<std::string_view, 7> endings{".png", ".exr", ".tif", ".tiff", ".npy", ".pfm", ".raw"};
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
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
  check_resolution(image.resolution, camera.resolution, "depth image");
  constexpr std::uint16_t all_bits = 65535;
  return converted(image.values, camera, encoding, [&](std::uint16_t value) {
    if (encoding.no_return == value) return double{RangeImage::no_return};
    return value == all_bits ? double{RangeImage::unknown} : encoding.metres_per_unit * value;
  });
}

RangeImage range_image(const FloatImage& image, const RangeCamera& camera, const DepthEncoding& encoding) {
  check_resolution(image.resolution, camera.resolution, "depth image");
  return converted(image.values, camera, encoding,
                   [&](float value) { return encoding.metres_per_float * static_cast<double>(value); });
}

Gray16 masked(Gray16 image, const Mask& mask) { return without_masked(std::move(image), mask); }
FloatImage masked(FloatImage image, const Mask& mask) { return without_masked(std::move(image), mask); }

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

DepthPixels decode_depth(std::string_view bytes, const std::optional<Resolution>& raw, const std::string& name,
                         std::int64_t most_pixels) {
  if (is_png(bytes)) return decode_png16(bytes, name, most_pixels);
  if (is_exr(bytes)) return decode_exr(bytes, name, most_pixels);
  if (is_tiff(bytes)) return decode_tiff(bytes, name, most_pixels);
  if (is_npy(bytes)) return decode_npy(bytes, name, most_pixels);
  if (is_pfm(bytes)) return decode_pfm(bytes, name, most_pixels);
  require(raw.has_value(), name,
          ": the size of a raw image is not known; the intrinsics must have it (a .yaml or .json file)");
  require_pixels(*raw, most_pixels, name);
  return decode_raw(bytes, *raw, name);
}

void require_resolution(const DepthPixels& pixels, Resolution camera, const std::string& name) {
  check_resolution(std::visit([](const auto& image) { return image.resolution; }, pixels), camera, name);
}

RangeImage parse_depth_raw(std::string_view bytes, const RangeCamera& camera, const DepthEncoding& encoding,
                           const std::string& name) {
  return range_image(decode_raw(bytes, camera.resolution, name), camera, encoding);
}

RangeImage read_depth_image(const std::filesystem::path& path, const RangeCamera& camera,
                            const DepthEncoding& encoding) {
  require(is_depth_ending(path.extension().string()), path.string(),
          ": a depth image must be a .png, .exr, .tif, .npy, .pfm or .raw file");
  const DepthPixels pixels = decode_depth(read_file(path), camera.resolution, path.string());
  require_resolution(pixels, camera.resolution, path.string());
  return std::visit([&](const auto& image) { return range_image(image, camera, encoding); }, pixels);
}

Resolution read_depth_resolution(const std::filesystem::path& path) {
  const DepthPixels pixels = decode_depth(read_file(path), std::nullopt, path.string());
  return std::visit([](const auto& image) { return image.resolution; }, pixels);
}

void write_depth_png(const std::filesystem::path& path, const RangeImage& image, const DepthEncoding& encoding) {
  write_file_atomically(path, encode_png16(depth_pixels(image, encoding)));
}

}  // namespace vantage
