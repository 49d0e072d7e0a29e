#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "vantage/formats/exr.hpp"
#include "vantage/formats/png16.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// A number as a depth image writes it, infinite ones included.
struct PixelValue {
  double value = 0;
  bool operator==(const PixelValue&) const = default;
};

/// What a depth is measured along: the viewing axis (z), or the ray of its pixel (the distance).
enum class DepthAlong { axis, ray };
[[nodiscard]] inline auto names_of(DepthAlong) {
  return std::array{std::pair{DepthAlong::axis, std::string_view("axis")},
                    std::pair{DepthAlong::ray, std::string_view("ray")}};
}

/// What the numbers of a depth image mean. 0 is always "unknown"; so is 65535 of 16 bits, which many sensors write
/// where they have measured nothing, unless it is `no_return`.
struct DepthEncoding {
  double metres_per_unit = 0.001;
  /// The number that tells "nothing is there", where the sensor reports that; 65535 in our own frames.
  std::optional<std::uint16_t> no_return = std::nullopt;
  double metres_per_float = 1;  // of images whose pixels are floating-point numbers
  /// One more number that says "unknown".
  std::optional<PixelValue> unknown = std::nullopt;
  DepthAlong along = DepthAlong::axis;

  /// Throws InputError naming the field.
  void validate() const;
};

/// Millimetres, and 65535 for no return: the frames that Vantage itself writes.
inline constexpr DepthEncoding own_depth_encoding{.metres_per_unit = 0.001, .no_return = 65535};

/// Depths in metres from an image of the camera's resolution. Nearer than the camera's min_depth is unknown: it is
/// likely the robot. Farther than max_depth is no return: nothing was met within the limits.
[[nodiscard]] RangeImage range_image(const Gray16& image, const RangeCamera& camera, const DepthEncoding& encoding);
/// The same for floating-point numbers: infinite ones are no return; 0, negative ones and NaN are unknown.
[[nodiscard]] RangeImage range_image(const FloatImage& image, const RangeCamera& camera, const DepthEncoding& encoding);
/// The image with the pixels that do not count made unknown (0). Throws InputError where the mask has another size.
[[nodiscard]] Gray16 masked(Gray16 image, const Mask& mask);
[[nodiscard]] FloatImage masked(FloatImage image, const Mask& mask);
/// The other way round, rounded to the nearest unit. Throws InputError where a depth needs more than 16 bits.
[[nodiscard]] Gray16 depth_pixels(const RangeImage& image, const DepthEncoding& encoding);

/// What a depth image holds.
using DepthPixels = std::variant<Gray16, FloatImage>;

/// A depth image from memory: PNG (16 bit), OpenEXR, TIFF, NumPy array or portable float map by their first bytes, else
/// float32, little endian, row by row, of the resolution `raw`. Throws InputError with `name` where it is damaged, of
/// another kind, of another size, or has more than `most_pixels`.
[[nodiscard]] DepthPixels decode_depth(std::string_view bytes, const std::optional<Resolution>& raw,
                                       const std::string& name, std::int64_t most_pixels = any_pixels);

/// Throws InputError with `name` where the image has another size than its camera.
void require_resolution(const DepthPixels& pixels, Resolution camera, const std::string& name);

/// The pixels of a depth image by the ending of its name: `.png` (16 bit, see DepthEncoding), `.exr`, `.tif`, `.npy`,
/// `.pfm`, or `.raw` (float32, little endian, row by row). Throws InputError naming the file where it is damaged, of
/// another kind, or not of the camera's resolution.
[[nodiscard]] RangeImage read_depth_image(const std::filesystem::path& path, const RangeCamera& camera,
                                          const DepthEncoding& encoding);
[[nodiscard]] RangeImage parse_depth_png(std::string_view bytes, const RangeCamera& camera,
                                         const DepthEncoding& encoding, const std::string& name);
[[nodiscard]] RangeImage parse_depth_raw(std::string_view bytes, const RangeCamera& camera,
                                         const DepthEncoding& encoding, const std::string& name);

/// Columns and rows of a depth image that says them, as all but raw ones do.
[[nodiscard]] Resolution read_depth_resolution(const std::filesystem::path& path);

/// Writes a 16-bit PNG, atomically.
void write_depth_png(const std::filesystem::path& path, const RangeImage& image,
                     const DepthEncoding& encoding = own_depth_encoding);

}  // namespace vantage
