#include <fmt/format.h>

#include <bit>

#include "vantage/core/error.hpp"
#include "vantage/files/byte_reader.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/recordings/ros_image.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t longest_packed_side = 16384;
// Runs of zeros make large images from a few bytes; this is twelve times what sensors have.
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 26;

/// Numbers of groups of three bits, each with a fourth bit that says whether there is more; eight groups in a word.
class RvlNumbers {
 public:
  RvlNumbers(std::string_view bytes, const std::string& name) : reader_(bytes, name) {}

  std::uint32_t next() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 32; shift += 3) {
      const std::uint32_t group = next_group();
      value |= (group & 7U) << shift;
      if ((group & 8U) == 0) return value;
    }
    throw InputError(reader_.name() + ": an RVL number is longer than 32 bits");
  }

 private:
  std::uint32_t next_group() {
    if (left_ == 0) {
      word_ = reader_.u32("RVL data");
      left_ = 8;
    }
    const std::uint32_t group = word_ >> 28U;
    word_ <<= 4U;
    --left_;
    return group;
  }

  ByteReader reader_;
  std::uint32_t word_ = 0;
  int left_ = 0;
};

Gray16 rvl_image(std::string_view bytes, const std::string& name) {
  ByteReader reader(bytes, name);
  const std::uint32_t columns = reader.u32("RVL columns"), rows = reader.u32("RVL rows");
  const bool is_valid = columns >= 1 && rows >= 1 && columns <= longest_packed_side && rows <= longest_packed_side;
  require(is_valid && std::uint64_t{columns} * rows <= most_pixels, name, ": an image of ", columns, "x", rows,
          " pixels; sides must be within 1 and ", longest_packed_side, ", with at most ", most_pixels, " pixels");
  const std::size_t pixels = std::size_t{columns} * rows;
  return {{static_cast<int>(columns), static_cast<int>(rows)}, unpack_rvl(bytes.substr(8), pixels, name)};
}

/// Depths in metres from numbers that count their inverse: depth = a / (number - b); 0 is unknown.
FloatImage from_inverse(const Gray16& image, float a, float b) {
  FloatImage depth{image.resolution, {}};
  depth.values.reserve(image.values.size());
  for (const std::uint16_t value : image.values)
    depth.values.push_back(value == 0 ? 0.0F : a / (static_cast<float>(value) - b));
  return depth;
}

}  // namespace

std::vector<std::uint16_t> unpack_rvl(std::string_view bytes, std::size_t pixels, const std::string& name) {
  std::vector<std::uint16_t> values;
  values.reserve(pixels);
  RvlNumbers numbers(bytes, name);
  std::uint32_t value = 0;
  while (values.size() < pixels) {
    const std::uint32_t zeros = numbers.next(), others = numbers.next();
    const std::size_t left = pixels - values.size();
    require(zeros <= left && others <= left - zeros, name, ": RVL data gives more than ", pixels, " pixels");
    require(zeros + others > 0, name, ": RVL data has an empty run");
    values.resize(values.size() + zeros, 0);
    for (std::uint32_t i = 0; i < others; ++i) {
      const std::uint32_t zigzag = numbers.next();
      value += (zigzag >> 1U) ^ (0U - (zigzag & 1U));
      values.push_back(static_cast<std::uint16_t>(value));
    }
  }
  return values;
}

DepthPixels depth_of(const RosCompressedImage& image, const std::string& name) {
  const bool is_compressed_depth = image.format.find("compressedDepth") != std::string::npos;
  if (!is_compressed_depth && is_png(image.data)) return decode_png16(image.data, name);
  require(is_compressed_depth, name, ": the format ", in_quotes(image.format),
          " is none of depth images; must be compressedDepth or a PNG of 16 bits");
  ByteReader head(image.data, name);
  (void)head.u32("the head of compressedDepth");
  const auto a = std::bit_cast<float>(head.u32("the head of compressedDepth"));
  const auto b = std::bit_cast<float>(head.u32("the head of compressedDepth"));
  const std::string_view data = image.data.substr(head.position());
  Gray16 values = is_png(data) ? decode_png16(data, name) : rvl_image(data, name);
  if (image.format.find("32FC1") == std::string::npos) return values;
  return from_inverse(values, a, b);
}

}  // namespace vantage
