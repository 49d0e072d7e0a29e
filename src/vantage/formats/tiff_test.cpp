#include "vantage/formats/tiff.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

/// Files of the corpus are written by tifffile 2023.2.3, Pillow 9.4 and the tiffcp of libtiff 4.5.0, each with 24x18
/// pixels: 500 + x + 10 y of whole numbers, else 0.5 + x + 10 y.
std::string tiff(const std::string& name) { return read_file(concat(VANTAGE_FUZZ_CORPUS, "/image/depth_tiff/", name)); }

std::string tiff_error(const std::string& bytes) {
  return input_error_of([&] { (void)decode_tiff(bytes, "a.tif"); });
}

template <class Image>
void expect_ramp(const std::string& name, double first) {
  SCOPED_TRACE(name);
  const DepthPixels pixels = decode_depth(tiff(name), std::nullopt, name);
  const auto* image = std::get_if<Image>(&pixels);
  ASSERT_NE(image, nullptr);
  ASSERT_EQ(image->resolution, (Resolution{24, 18}));
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 24; ++x)
      EXPECT_EQ(static_cast<double>(image->values[static_cast<std::size_t>(24 * y + x)]), first + x + 10 * y);
  }
}

TEST(Tiff, ReadsWholeNumbersOfOtherWriters) {
  for (const char* name :
       {"tifffile-uint16", "tifffile-uint16-big", "tifffile-int32", "tifffile-bigtiff", "pillow-deflate", "pillow-lzma",
        "pillow-lzw", "pillow-packbits", "pillow-zstd", "tiffcp-lzw-predictor", "tiffcp-zstd"})
    expect_ramp<Gray16>(name, 500);
}

TEST(Tiff, ReadsFloatsOfOtherWriters) {
  for (const char* name : {"tifffile-float16", "tifffile-float32", "tifffile-float64-zlib", "tifffile-tiled",
                           "pillow-float-lzw", "tiffcp-tiled-predictor", "tiffcp-big-packbits"})
    expect_ramp<FloatImage>(name, 0.5);
}

TEST(Tiff, WhatIsNoDepthImageIsNamed) {
  EXPECT_EQ(tiff_error("P6 3 2"), "a.tif: is no TIFF file");
  EXPECT_EQ(tiff_error(tiff("tifffile-colour")), "a.tif: has 3 channels; a depth image must have one");
  EXPECT_EQ(
      tiff_error(tiff("tifffile-uint8")),
      "a.tif: has pixels of 8 bits, sample format 1; must be whole numbers of 16 or 32 bits, or floats of 16 to 64");
  EXPECT_EQ(tiff_error(tiff("tifffile-pages")), "a.tif: has several pages; a depth image must be the only one");
  EXPECT_THAT(tiff_error(tiff("tifffile-miniswhite")), HasSubstr("has the photometric interpretation 0; must be 1"));
}

TEST(Tiff, SizesAreAskedBeforeMemoryIsTaken) {
  EXPECT_THAT(input_error_of([] { (void)decode_tiff(tiff("tifffile-uint16"), "a.tif", 100); }), HasSubstr("a.tif: "));
  std::string wide = tiff("tifffile-uint16");
  // The entry of the tag ImageWidth (256): a number of four bytes, one of it, 24.
  const std::string entry("\x00\x01\x04\x00\x01\x00\x00\x00\x18\x00", 10);
  const std::size_t at = wide.find(entry);
  ASSERT_NE(at, std::string::npos);
  wide[at + 9] = 0x40;
  EXPECT_THAT(tiff_error(wide), HasSubstr("a.tif: has 16408x18 pixels; must have 1 to 16384 on each side"));
  wide[at + 9] = 0x30;
  EXPECT_THAT(tiff_error(wide), HasSubstr("12312x18 pixels are announced, which 1072 bytes cannot hold"));
}

TEST(Tiff, DamagedAndCutOffFilesAreRefused) {
  for (const char* name : {"tifffile-uint16", "pillow-zstd", "tiffcp-tiled-predictor", "tiffcp-lzw-predictor"}) {
    SCOPED_TRACE(name);
    const std::string whole = tiff(name);
    std::size_t refused = 0;
    for (std::size_t size = 0; size < whole.size(); size += 7) {
      try {
        (void)decode_tiff(whole.substr(0, size), "a.tif");
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GE(refused + 20, whole.size() / 7) << "what ends the file may be padding or a text";
    const FuzzCount count =
        read_damaged(whole, 2000, [](const std::string& damaged) { (void)decode_tiff(damaged, "a.tif"); });
    EXPECT_EQ(count.accepted + count.refused, 2000);
  }
}

}  // namespace
}  // namespace vantage
