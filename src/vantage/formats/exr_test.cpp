#include "vantage/formats/exr.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

template <class Value>
std::string raw(Value value) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  return bytes;
}

std::string word(const std::string& text) { return text + '\0'; }

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return word(name) + word(type) + raw(static_cast<std::uint32_t>(value.size())) + value;
}

std::string channel(const std::string& name, std::uint32_t type, std::int32_t sampling = 1) {
  return word(name) + raw(type) + std::string(4, '\0') + raw(sampling) + raw(sampling);
}

std::string window(int columns, int rows) { return raw(0) + raw(0) + raw(columns - 1) + raw(rows - 1); }

struct Image {
  std::string channels = channel("Z", 2);
  std::string data_window = window(3, 2), display_window = window(3, 2);
  char compression = 0;
  std::uint32_t version = 2;
  std::vector<std::string> lines{raw(0.5F) + raw(1.5F) + raw(2.5F), raw(10.5F) + raw(11.5F) + raw(12.5F)};

  /// The file, written out by the layout that openexr.com describes.
  [[nodiscard]] std::string bytes() const {
    std::string file = raw(std::uint32_t{20000630}) + raw(version);
    file += attribute("channels", "chlist", channels + '\0');
    file += attribute("compression", "compression", std::string(1, compression));
    file += attribute("dataWindow", "box2i", data_window);
    file += attribute("displayWindow", "box2i", display_window);
    file += attribute("owner", "string", "nobody");
    file += '\0';
    std::size_t at = file.size() + 8 * lines.size();
    std::string chunks;
    for (std::size_t y = 0; y < lines.size(); ++y) {
      file += raw(static_cast<std::uint64_t>(at + chunks.size()));
      chunks += raw(static_cast<std::int32_t>(y)) + raw(static_cast<std::uint32_t>(lines[y].size())) + lines[y];
    }
    return file + chunks;
  }
};

TEST(Exr, ReadsTheOnlyChannelRowByRow) {
  const FloatImage image = decode_exr(Image().bytes(), "a.exr");
  EXPECT_EQ(image.resolution, (Resolution{3, 2}));
  EXPECT_THAT(image.values, ElementsAre(0.5F, 1.5F, 2.5F, 10.5F, 11.5F, 12.5F));
  EXPECT_TRUE(is_exr(Image().bytes()));
  EXPECT_FALSE(is_exr("\x89PNG"));
}

TEST(Exr, TakesZOfSeveralChannels) {
  Image image;
  image.channels = channel("A", 1) + channel("layer.Z", 2) + channel("mist", 0);
  for (std::string& line : image.lines) line = std::string(6, 'h') + line + std::string(12, 'u');
  EXPECT_THAT(decode_exr(image.bytes(), "a.exr").values, ElementsAre(0.5F, 1.5F, 2.5F, 10.5F, 11.5F, 12.5F));
  image.channels = channel("B", 1) + channel("G", 2) + channel("R", 0);
  EXPECT_EQ(input_error_of([&] { (void)decode_exr(image.bytes(), "a.exr"); }),
            "a.exr: has the channels 'B', 'G', 'R'; depth must be the only one, or called Z or Y");
}

TEST(Exr, HalvesAndWholeNumbersBecomeFloats) {
  Image image;
  image.channels = channel("Y", 1);
  // 1.5 = 0 01111 1000000000, -2 = 1 10000 0, the smallest subnormal 2^-24, the largest 65504, infinity, NaN.
  image.lines = {raw(std::uint16_t{0x3e00}) + raw(std::uint16_t{0xc000}) + raw(std::uint16_t{0x0001}),
                 raw(std::uint16_t{0x7bff}) + raw(std::uint16_t{0x7c00}) + raw(std::uint16_t{0x7e00})};
  const std::vector<float> halves = decode_exr(image.bytes(), "a.exr").values;
  EXPECT_THAT(std::vector(halves.begin(), halves.end() - 1),
              ElementsAre(1.5F, -2.0F, std::ldexp(1.0F, -24), 65504.0F, std::numeric_limits<float>::infinity()));
  EXPECT_TRUE(std::isnan(halves.back()));
  image.channels = channel("Y", 0);
  image.lines = {raw(std::uint32_t{7}) + raw(std::uint32_t{0}) + raw(std::uint32_t{1000}), std::string(12, '\0')};
  EXPECT_THAT(decode_exr(image.bytes(), "a.exr").values, ElementsAre(7.0F, 0.0F, 1000.0F, 0.0F, 0.0F, 0.0F));
}

TEST(Exr, UnpacksRunsByHand) {
  Image image;
  image.compression = 1;
  // Rows of 12 zero bytes: their differences are 128 but for the first, 0. One literal byte, then a run of eleven.
  image.lines = {raw(std::int8_t{-1}) + '\0' + raw(std::int8_t{10}) + '\x80', image.lines[1]};
  EXPECT_THAT(decode_exr(image.bytes(), "a.exr").values, ElementsAre(0.0F, 0.0F, 0.0F, 10.5F, 11.5F, 12.5F))
      << "the second row did not get smaller, so it is stored as it is";
}

// Written by OpenEXR 3.1.5, each with depths 0.5 + x + 10 y; the tiles of 8x8 and 5x7 pixels by its exrmaketiled.
TEST(Exr, ReadsWhatOpenExrWrites) {
  int files = 0;
  for (const char* name : {"none", "rle", "zips", "zip", "zip-half", "zip-rgbz", "zip-decreasing", "zip-offset", "piz",
                           "tiled", "tiled-piz", "tiled-odd", "tiled-levels", "pxr24"}) {
    SCOPED_TRACE(name);
    const std::string path = concat(VANTAGE_FUZZ_CORPUS, "/image/exr/openexr-", name);
    const FloatImage image = decode_exr(read_file(path), path);
    ASSERT_EQ(image.resolution, (Resolution{24, 18}));
    for (int y = 0; y < 18; ++y) {
      for (int x = 0; x < 24; ++x) {
        EXPECT_EQ(image.values[static_cast<std::size_t>(24 * y + x)], 0.5F + static_cast<float>(x + 10 * y));
      }
    }
    ++files;
  }
  EXPECT_EQ(files, 14);
  const auto error = [](const char* name) {
    const std::string path = concat(VANTAGE_FUZZ_CORPUS, "/image/exr/openexr-", name);
    return input_error_of([&] { (void)decode_exr(read_file(path), name); });
  };
  EXPECT_EQ(error("dwaa"),
            "dwaa: is compressed by DWAA, which changes depths; must be saved with ZIP, ZIPS, PIZ, PXR24, RLE or no "
            "compression");
  EXPECT_THAT(error("cropped"), HasSubstr("holds only a part of its image; must be saved uncropped"));
}

TEST(Exr, RefusesWhatIsDamagedAndSaysHow) {
  const auto error = [](const Image& image) {
    return input_error_of([&] { (void)decode_exr(image.bytes(), "a.exr"); });
  };
  EXPECT_EQ(input_error_of([] { (void)decode_exr("P6 3 2", "a.exr"); }), "a.exr: is not an OpenEXR file");
  EXPECT_THAT(error({.version = 3}), StartsWith("a.exr: is damaged or cut off: "));
  EXPECT_THAT(error({.version = 2 | 0x800}), StartsWith("a.exr: is damaged or cut off: "));
  EXPECT_THAT(error({.channels = channel("Z", 3)}), StartsWith("a.exr: is damaged or cut off: "));
  EXPECT_THAT(error({.channels = channel("Z", 2, 2)}), HasSubstr("subsampling factor (2)"));
  EXPECT_THAT(error({.channels = ""}), HasSubstr("At least one channel required"));
  EXPECT_THAT(error({.data_window = window(0, 2), .display_window = window(0, 2)}),
              HasSubstr("Invalid display window (0, 0 - -1, 1)"));
  EXPECT_THAT(error({.data_window = window(16000, 16000), .display_window = window(16000, 16000)}),
              HasSubstr("16000x16000 pixels are announced, which"));
  EXPECT_THAT(error({.compression = 3}), HasSubstr("damaged"));
  EXPECT_THAT(error({.lines = {raw(0.5F), raw(1.5F)}}), HasSubstr("Unable to read pixel data block"));
  Image moved;
  std::string bytes = moved.bytes();
  bytes[bytes.find(raw(0) + raw(std::uint32_t{12}))] = 1;  // says that the first row is the second
  EXPECT_THAT(input_error_of([&] { (void)decode_exr(bytes, "a.exr"); }), HasSubstr("scanline says 1, expected 0"));
  const FuzzCount count =
      read_damaged(moved.bytes(), 2000, [](const std::string& damaged) { (void)decode_exr(damaged, "a.exr"); });
  EXPECT_EQ(count.accepted + count.refused, 2000);
  EXPECT_GT(count.refused, 500);
}

}  // namespace
}  // namespace vantage
