#include "vantage/recordings/ros_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/byte_reader.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t longest_ros_side = 16384;

Resolution ros_resolution(const RosImage& image, std::size_t bytes_per_pixel, const std::string& name) {
  const bool is_valid =
      image.width >= 1 && image.height >= 1 && image.width <= longest_ros_side && image.height <= longest_ros_side;
  require(is_valid, name, ": an image of ", image.width, "x", image.height, " pixels; sides must be within 1 and ",
          longest_ros_side);
  const std::uint64_t row = std::uint64_t{image.width} * bytes_per_pixel;
  require(image.step >= row, name, ": step = ", image.step, " bytes; ", image.width, " pixels of ", image.encoding,
          " need ", row);
  // The last row need not be filled up.
  const std::uint64_t least = std::uint64_t{image.step} * (image.height - 1) + row;
  require(image.data.size() >= least, name, ": has ", image.data.size(), " bytes of pixels, must have ", least);
  return {static_cast<int>(image.width), static_cast<int>(image.height)};
}

/// Calls `take(bytes of a row)` for each row.
template <class Take>
void for_each_row(const RosImage& image, const Take& take) {
  for (std::uint32_t row = 0; row < image.height; ++row) take(image.data.data() + std::size_t{row} * image.step);
}

std::uint16_t u16(const char* at, bool is_big_endian) {
  const auto value = static_cast<std::uint16_t>(little_endian<2>(at));
  return is_big_endian ? static_cast<std::uint16_t>((value >> 8U) | (value << 8U)) : value;
}

std::uint32_t u32(const char* at, bool is_big_endian) {
  const auto value = static_cast<std::uint32_t>(little_endian<4>(at));
  if (!is_big_endian) return value;
  return (value >> 24U) | ((value >> 8U) & 0xFF00U) | ((value << 8U) & 0xFF0000U) | (value << 24U);
}

/// Bytes per pixel, and where red, green and blue are in them.
struct ColorLayout {
  std::string_view encoding;
  std::size_t bytes;
  std::array<std::size_t, 3> channel;
};
constexpr std::array<ColorLayout, 8> color_layouts{{{"rgb8", 3, {0, 1, 2}},
                                                    {"bgr8", 3, {2, 1, 0}},
                                                    {"8UC3", 3, {2, 1, 0}},
                                                    {"rgba8", 4, {0, 1, 2}},
                                                    {"bgra8", 4, {2, 1, 0}},
                                                    {"8UC4", 4, {2, 1, 0}},
                                                    {"mono8", 1, {0, 0, 0}},
                                                    {"8UC1", 1, {0, 0, 0}}}};

const ColorLayout* color_layout(std::string_view encoding) {
  const auto* found = std::find_if(color_layouts.begin(), color_layouts.end(),
                                   [&](const ColorLayout& layout) { return layout.encoding == encoding; });
  return found == color_layouts.end() ? nullptr : found;
}

bool is_of_shorts(std::string_view encoding) { return encoding == "16UC1" || encoding == "mono16"; }

}  // namespace

bool is_depth_encoding(std::string_view encoding) { return is_of_shorts(encoding) || encoding == "32FC1"; }

bool is_color_encoding(std::string_view encoding) { return color_layout(encoding) != nullptr; }

DepthPixels depth_of(const RosImage& image, const std::string& name) {
  require(is_depth_encoding(image.encoding), name, ": the encoding ", in_quotes(image.encoding),
          " is none of depth images; must be 16UC1, mono16 or 32FC1");
  if (is_of_shorts(image.encoding)) {
    Gray16 depth{ros_resolution(image, 2, name), {}};
    depth.values.reserve(static_cast<std::size_t>(depth.resolution.rays()));
    for_each_row(image, [&](const char* row) {
      for (std::size_t i = 0; i < image.width; ++i) depth.values.push_back(u16(row + 2 * i, image.is_big_endian));
    });
    return depth;
  }
  FloatImage depth{ros_resolution(image, 4, name), {}};
  depth.values.reserve(static_cast<std::size_t>(depth.resolution.rays()));
  for_each_row(image, [&](const char* row) {
    for (std::size_t i = 0; i < image.width; ++i)
      depth.values.push_back(std::bit_cast<float>(u32(row + 4 * i, image.is_big_endian)));
  });
  return depth;
}

ColorImage color_of(const RosImage& image, const std::string& name) {
  const ColorLayout* layout = color_layout(image.encoding);
  require(layout != nullptr, name, ": the encoding ", in_quotes(image.encoding),
          " is none of colour images that are read; must be rgb8, bgr8, rgba8, bgra8 or mono8");
  ColorImage color{ros_resolution(image, layout->bytes, name), {}};
  color.pixels.reserve(static_cast<std::size_t>(color.resolution.rays()));
  for_each_row(image, [&](const char* row) {
    for (std::size_t i = 0; i < image.width; ++i) {
      const auto at = [&](std::size_t channel) {
        return static_cast<std::uint8_t>(row[i * layout->bytes + layout->channel[channel]]);
      };
      color.pixels.push_back({at(0), at(1), at(2)});
    }
  });
  return color;
}

Intrinsics intrinsics_of(const RosCameraInfo& info, bool is_rectified, const std::string& name) {
  const bool has_projection = info.p[0] > 0 && info.p[5] > 0;
  Intrinsics intrinsics;
  if (is_rectified && has_projection) {
    intrinsics = {info.p[0], info.p[5], info.p[2], info.p[6], std::nullopt, {}};
  } else {
    Mat3 k;
    k << info.k[0], info.k[1], info.k[2], info.k[3], info.k[4], info.k[5], info.k[6], info.k[7], info.k[8];
    require(k(0, 0) > 0, name, ": K is not filled in; the camera is not calibrated, give a file with --intrinsics");
    intrinsics = intrinsics_of(k, name);
    intrinsics.distortion = info.distortion;
    require(!intrinsics.is_distorted() || info.distortion_model == "plumb_bob" ||
                info.distortion_model == "rational_polynomial" || info.distortion_model.empty(),
            name, ": distortion_model ", in_quotes(info.distortion_model),
            ": must be plumb_bob or rational_polynomial; rectify the images first");
  }
  // The message is about the whole sensor; the image may be a part of it, with pixels put together.
  const double bin_x = std::max(info.binning_x, 1U), bin_y = std::max(info.binning_y, 1U);
  intrinsics.fx /= bin_x;
  intrinsics.fy /= bin_y;
  intrinsics.cx = (intrinsics.cx - info.roi_x) / bin_x;
  intrinsics.cy = (intrinsics.cy - info.roi_y) / bin_y;
  const double width = (info.roi_width > 0 ? info.roi_width : info.width) / bin_x;
  const double height = (info.roi_height > 0 ? info.roi_height : info.height) / bin_y;
  if (width >= 1 && height >= 1 && width <= longest_ros_side && height <= longest_ros_side)
    intrinsics.resolution = Resolution{static_cast<int>(width), static_cast<int>(height)};
  try {
    intrinsics.validate();
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
  return intrinsics;
}

}  // namespace vantage
