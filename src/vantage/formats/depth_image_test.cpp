#include "vantage/formats/depth_image.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <cmath>
#include <limits>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float no_return = RangeImage::no_return;

RangeCamera small_camera() {
  RangeCamera camera = camera_from_apertures(radians(45), radians(45), {3, 2});
  camera.min_depth = 0.25;
  camera.max_depth = 4.5;
  return camera;
}

Gray16 random_image() {
  Random random(1);
  Gray16 image{{40, 30}, std::vector<std::uint16_t>(1200)};
  for (std::uint16_t& value : image.values) value = static_cast<std::uint16_t>(1000 + random.index(200));
  return image;
}

/// A PNG of another kind, made by libpng's own simple interface.
std::string png_of_format(png_uint_32 format) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 4;
  image.height = 4;
  image.format = format;
  const std::vector<std::uint16_t> pixels(64, 7);
  const std::vector<std::uint16_t> colors(1024, 7);
  png_alloc_size_t size = 4096;
  std::string bytes(size, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, colors.data()), 0);
  bytes.resize(size);
  return bytes;
}

std::string error_in(const std::string& bytes) {
  return input_error_of([&] { (void)decode_png16(bytes, "a.png"); });
}

TEST(Png16, WhatIsEncodedIsDecoded) {
  Gray16 image{{3, 2}, {0, 1, 255, 256, 32768, 65535}};
  EXPECT_EQ(decode_png16(encode_png16(image), "a.png").values, image.values);
  image = random_image();
  const Gray16 again = decode_png16(encode_png16(image), "a.png");
  EXPECT_EQ(again.resolution, image.resolution);
  EXPECT_EQ(again.values, image.values);
  EXPECT_THAT(input_error_of([] { (void)encode_png16({{3, 2}, {1, 2}}); }), HasSubstr("2 values for 3x2 pixels"));
}

TEST(Png16, OtherKindsOfImagesAreRefused) {
  EXPECT_EQ(error_in(""), "a.png: is empty");
  EXPECT_EQ(error_in("P5 3 2 65535"), "a.png: is not a PNG file");
  EXPECT_EQ(error_in(png_of_format(PNG_FORMAT_GRAY)),
            "a.png: is a PNG image of another kind (grey, 8 bits); depth must be grey, 16 bits");
  EXPECT_THAT(error_in(png_of_format(PNG_FORMAT_RGB)), HasSubstr("(colour, 8 bits)"));
  EXPECT_THAT(error_in(png_of_format(PNG_FORMAT_LINEAR_RGB)), HasSubstr("(colour, 16 bits)"));
  EXPECT_THAT(error_in(png_of_format(PNG_FORMAT_LINEAR_Y_ALPHA)), HasSubstr("(grey with alpha, 16 bits)"));
}

/// An 8-bit image of 3x2 pixels.
std::string png_of(png_uint_32 format, const std::vector<std::uint8_t>& values) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 3;
  image.height = 2;
  image.format = format;
  png_alloc_size_t size = 4096;
  std::string bytes(size, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, values.data(), 0, nullptr), 0);
  bytes.resize(size);
  return bytes;
}

TEST(PngMask, TransparentPixelsDoNotCountWhateverTheirColour) {
  const auto mask = [](png_uint_32 format, const std::vector<std::uint8_t>& values) {
    return decode_png_mask(png_of(format, values), {3, 2}, "a.png");
  };
  EXPECT_THAT(mask(PNG_FORMAT_GA, {0, 255, 9, 0, 0, 255, 9, 255, 0, 0, 7, 1}), ElementsAre(1, 0, 1, 1, 0, 1));
  EXPECT_THAT(mask(PNG_FORMAT_RGBA, {0, 0, 0, 255, 9, 9, 9, 0, 0, 0, 0, 255, 9, 0, 0, 255, 0, 0, 0, 0, 7, 7, 7, 1}),
              ElementsAre(1, 0, 1, 1, 0, 1));
  EXPECT_THAT(mask(PNG_FORMAT_GA, {0, 255, 9, 255, 0, 255, 9, 255, 0, 255, 7, 255}), ElementsAre(0, 1, 0, 1, 0, 1))
      << "where nothing is transparent colours say it";
}

TEST(Png16, CutOffOrDamagedAnywhereItIsAnError) {
  const std::string bytes = encode_png16(random_image());
  int refused = 0;
  for (std::size_t length = 1; length < bytes.size(); ++length) {
    EXPECT_NE(error_in(bytes.substr(0, length)), "") << length;
    ++refused;
  }
  EXPECT_EQ(refused, static_cast<int>(bytes.size()) - 1);
  EXPECT_THAT(error_in(bytes.substr(0, 100)), HasSubstr("the file is cut off"));
  std::string damaged = bytes;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  EXPECT_THAT(error_in(damaged), HasSubstr("a.png: IDAT"));
}

TEST(Png16, AHeaderThatPromisesTooMuchReservesNoMemory) {
  std::string bytes = encode_png16(random_image());
  bytes.replace(16, 8, std::string("\0\0\x40\0\0\0\x40\0", 8));  // 16384 x 16384; the checksum is wrong as well
  EXPECT_THAT(error_in(bytes), HasSubstr("CRC error"));
  bytes.replace(29, 4, std::string("\xc9\x67\xec\xcb", 4));
  EXPECT_NE(error_in(bytes), "");
}

TEST(DepthImage, UnitsMeanMetresWithinTheLimits) {
  const Gray16 pixels{{3, 2}, {0, 1234, 249, 250, 4501, 65535}};
  const RangeImage own = range_image(pixels, small_camera(), own_depth_encoding);
  EXPECT_THAT(own.depth, ElementsAre(0, 1.234F, 0, 0.25F, no_return, no_return));
  const RangeImage tenths = range_image(pixels, small_camera(), {.metres_per_unit = 0.0001, .no_return = 1234});
  EXPECT_THAT(tenths.depth, ElementsAre(0, no_return, 0, 0, 0.4501F, 0))
      << "65535 is no measurement where it is not said to be one of nothing";
}

TEST(DepthImage, OtherValuesMayMeanUnknownToo) {
  const Gray16 pixels{{3, 2}, {0, 1234, 9, 1000, 4501, 65535}};
  EXPECT_THAT(range_image(pixels, small_camera(), {.unknown = PixelValue{1000}}).depth,
              ElementsAre(0, 1.234F, 0, 0, no_return, 0));
  const float infinite = std::numeric_limits<float>::infinity();
  const FloatImage floats{{3, 2}, {1, infinite, 2, 0, -1, 9}};
  EXPECT_THAT(range_image(floats, small_camera(), {}).depth, ElementsAre(1, no_return, 2, 0, 0, no_return));
  EXPECT_THAT(range_image(floats, small_camera(), {.unknown = PixelValue{infinite}}).depth,
              ElementsAre(1, 0, 2, 0, 0, no_return));
}

TEST(DepthImage, DistancesAlongTheRayBecomeDepths) {
  RangeCamera camera = camera_from_intrinsics(2, 2, 1, 0.5, {3, 2});
  camera.max_depth = 1.9;
  const Gray16 distances{{3, 2}, {2000, 2000, 2000, 2000, 2000, 2000}};
  const RangeImage image = range_image(distances, camera, {.along = DepthAlong::ray});
  const RayGrid rays = camera.rays();
  int inside = 0;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (!RangeImage::is_hit(image.at(column, row))) continue;
      const double depth = static_cast<double>(image.at(column, row));
      EXPECT_NEAR(point_in_sensor(rays, column, row, depth).norm(), 2, 1e-6);
      ++inside;
    }
  }
  EXPECT_EQ(inside, 4) << "on the middle column the depth is 1.94 m, beyond the limit";
}

TEST(DepthImage, WhatIsWrittenIsReadToTheNearestUnit) {
  const TestFolder folder;
  const RangeImage image{small_camera(), {0, no_return, 0.5F, 1.2344F, 1.2346F, 4.5F}};
  write_depth_png(folder / "a.depth.png", image);
  EXPECT_EQ(read_depth_resolution(folder / "a.depth.png"), (Resolution{3, 2}));
  const RangeImage again = read_depth_image(folder / "a.depth.png", small_camera(), own_depth_encoding);
  EXPECT_THAT(again.depth, ElementsAre(0, no_return, 0.5F, 1.234F, 1.235F, 4.5F));
  EXPECT_THAT(depth_pixels(image, {.metres_per_unit = 0.01}).values, ElementsAre(0, 0, 50, 123, 123, 450))
      << "without no-return";
  EXPECT_THAT(depth_pixels({small_camera(), {1e-6F, 0, 0, 0, 0, 0}}, own_depth_encoding).values[0], 1)
      << "a hit stays one";
  EXPECT_THAT(input_error_of([&] {
                (void)depth_pixels({small_camera(), {70, 0, 0, 0, 0, 0}}, own_depth_encoding);
              }),
              HasSubstr("depth 70 m does not fit into 16 bits in units of 0.001 m; use a larger unit"));
}

TEST(DepthImage, RawFloatsAreMetres) {
  std::string bytes;
  for (const double value :
       {0.0, 1.5, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 9.0}) {
    append_float32(bytes, value);
  }
  EXPECT_THAT(parse_depth_raw(bytes, small_camera(), {}, "a.raw").depth,
              ElementsAre(0, 1.5F, 0, 0, no_return, no_return));
  EXPECT_EQ(input_error_of([&] { (void)parse_depth_raw(bytes.substr(1), small_camera(), {}, "a.raw"); }),
            "a.raw: has 23 bytes; 3x2 pixels of float32 are 24");
}

TEST(DepthImage, WrongSizesScalesAndNamesAreRefused) {
  const std::string bytes = encode_png16(random_image());
  EXPECT_EQ(input_error_of([&] { (void)parse_depth_png(bytes, small_camera(), {}, "a.png"); }),
            "a.png: has 40x30 pixels, the camera 3x2; do the intrinsics belong to another resolution?");
  EXPECT_THAT(input_error_of([] { DepthEncoding{.metres_per_unit = 0}.validate(); }),
              HasSubstr("depth scale = 0 m per unit: must be positive"));
  EXPECT_THAT(input_error_of([] { DepthEncoding{.metres_per_unit = 1000}.validate(); }),
              HasSubstr("metres per unit, not units per metre"));
  EXPECT_THAT(input_error_of([] { DepthEncoding{.no_return = std::uint16_t{0}}.validate(); }),
              HasSubstr("no_return = 0"));
  EXPECT_THAT(input_error_of([] { (void)read_depth_image("a.jpg", small_camera(), {}); }),
              HasSubstr("a.jpg: a depth image must be a .png, .exr, .tif, .npy, .pfm or .raw file"));
}

TEST(DepthImage, DamagedFilesAreReadOrRefused) {
  const FuzzCount count = read_damaged(encode_png16(random_image()), 2000, [](const std::string& bytes) {
    const Gray16 image = decode_png16(bytes, "a");
    ASSERT_EQ(image.values.size(), static_cast<std::size_t>(image.resolution.rays()));
  });
  EXPECT_EQ(count.accepted + count.refused, 2000);
  EXPECT_GT(count.refused, 1500);
}

TEST(DepthImage, ARealFrameIsRead) {
  const std::filesystem::path path =
      std::filesystem::path(VANTAGE_SHARED_DATA) / "scans/ur5_tray/frame-000150.depth.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
  EXPECT_EQ(read_depth_resolution(path), (Resolution{640, 480}));
  RangeCamera camera = camera_from_intrinsics(532.58, 532.21, 316.04, 236.03, {640, 480});
  camera.min_depth = 0.25;
  camera.max_depth = 1.5;
  const RangeImage image = read_depth_image(path, camera, {});
  int hits = 0;
  for (const float depth : image.depth) hits += RangeImage::is_hit(depth) ? 1 : 0;
  EXPECT_GT(hits, 100'000);
}

}  // namespace
}  // namespace vantage
