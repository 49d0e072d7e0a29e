#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "vantage/formats/exr.hpp"
#include "vantage/formats/png16.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// What the numbers of a 16-bit depth image mean. 0 is always "unknown".
struct DepthEncoding {
  double metres_per_unit = 0.001;
  /// The number that tells "nothing is there", where the sensor reports that; 65535 in our own frames.
  std::optional<std::uint16_t> no_return = std::nullopt;
  double metres_per_float = 1;  // of images whose pixels are floating-point numbers

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
/// The image with the pixels that do not count made unknown. Throws InputError where the mask has another size.
[[nodiscard]] RangeImage masked(RangeImage image, const Mask& mask);
/// The other way round, rounded to the nearest unit. Throws InputError where a depth needs more than 16 bits.
[[nodiscard]] Gray16 depth_pixels(const RangeImage& image, const DepthEncoding& encoding);

/// What a depth image holds.
using DepthPixels = std::variant<Gray16, FloatImage>;

/// A depth image from memory: PNG (16 bit) or OpenEXR by their first bytes, else float32, little endian, row by row, of
/// the resolution `raw`. Throws InputError with `name` where it is damaged, of another kind, of another size,
/// or has more than `most_pixels`.
[[nodiscard]] DepthPixels decode_depth(std::string_view bytes, const std::optional<Resolution>& raw,
                                       const std::string& name, std::int64_t most_pixels = any_pixels);

/// The pixels of a depth image by the ending of its name: `.png` (16 bit, see DepthEncoding), `.exr`, or `.raw`
/// (float32, little endian, row by row). Throws InputError naming the file where it is damaged, of another kind, or not
/// of the camera's resolution.
[[nodiscard]] RangeImage read_depth_image(const std::filesystem::path& path, const RangeCamera& camera,
                                          const DepthEncoding& encoding);
[[nodiscard]] RangeImage parse_depth_png(std::string_view bytes, const RangeCamera& camera,
                                         const DepthEncoding& encoding, const std::string& name);
[[nodiscard]] RangeImage parse_depth_raw(std::string_view bytes, const RangeCamera& camera,
                                         const DepthEncoding& encoding, const std::string& name);

/// Columns and rows of a PNG or OpenEXR depth image.
[[nodiscard]] Resolution read_depth_resolution(const std::filesystem::path& path);

/// Writes a 16-bit PNG, atomically.
void write_depth_png(const std::filesystem::path& path, const RangeImage& image,
                     const DepthEncoding& encoding = own_depth_encoding);

}  // namespace vantage
