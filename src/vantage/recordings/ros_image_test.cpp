#include "vantage/recordings/ros_image.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

TEST(MessageReader, CdrNumbersAreAlignedInEitherByteOrder) {
  const std::string little = bytes({0, 1, 0, 0, 7, 0, 0, 0, 5, 0, 0, 0, 3, 0, 0, 0, 'a', 'b', 0, 9, 0, 0, 0, 0});
  MessageReader reader(little, Serialization::cdr, "m");
  EXPECT_EQ(reader.u8(), 7);
  EXPECT_EQ(reader.u32(), 5U);
  EXPECT_EQ(reader.text(), "ab");
  EXPECT_EQ(reader.u8(), 9);
  const std::string big = bytes({0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0});
  MessageReader other(big, Serialization::cdr, "m");
  EXPECT_EQ(other.i32(), 5);
  EXPECT_EQ(other.f64(), 1.0);  // aligned to eight bytes
  const std::string second = bytes({0, 7, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F});
  MessageReader newer(second, Serialization::cdr, "m");
  EXPECT_EQ(newer.i32(), 5);
  EXPECT_EQ(newer.f64(), 1.0);  // version 2 aligns to four
}

TEST(MessageReader, WhatEndsTooEarlyIsRefused) {
  const std::string message = bytes({0, 1, 0, 0, 255, 255, 255, 255, 1});
  EXPECT_EQ(input_error_of([&] { (void)MessageReader(message, Serialization::cdr, "m").text(); }),
            "m: the message ends at byte 4; 4294967295 more are promised, 1 are there");
  EXPECT_THAT(input_error_of([&] { (void)MessageReader(message, Serialization::cdr, "m").list_size(8); }),
              HasSubstr("a list promises 4294967295 elements"));
  EXPECT_THAT(input_error_of([] { MessageReader("\0\3\0\0", Serialization::cdr, "m"); }), HasSubstr("m: "));
}

TEST(RosImage, RowsMayBeLongerThanTheirPixels) {
  RosImage image{RosHeader{}, 2, 2, "16UC1", false, 6, {}};
  const std::string data = bytes({1, 0, 2, 1, 99, 99, 3, 0, 4, 0});
  image.data = data;
  EXPECT_THAT(std::get<Gray16>(depth_of(image, "m")).values, ElementsAre(1, 258, 3, 4));
  image.is_big_endian = true;
  EXPECT_THAT(std::get<Gray16>(depth_of(image, "m")).values, ElementsAre(256, 513, 768, 1024));
  image.height = 3;
  EXPECT_EQ(input_error_of([&] { (void)depth_of(image, "m"); }), "m: has 10 bytes of pixels, must have 16");
  image.step = 3;
  EXPECT_EQ(input_error_of([&] { (void)depth_of(image, "m"); }), "m: step = 3 bytes; 2 pixels of 16UC1 need 4");
  image.width = 1U << 31U;
  EXPECT_THAT(input_error_of([&] { (void)depth_of(image, "m"); }), HasSubstr("sides must be within 1 and 16384"));
  image.encoding = "rgb8";
  EXPECT_THAT(input_error_of([&] { (void)depth_of(image, "m"); }), HasSubstr("must be 16UC1, mono16 or 32FC1"));
}

TEST(RosImage, ColorsComeInTheirOrder) {
  const std::string data = bytes({1, 2, 3, 4, 5, 6});
  const RosImage image{RosHeader{}, 1, 2, "bgr8", false, 6, data};
  const ColorImage color = color_of(image, "m");
  EXPECT_EQ(color.pixels.at(1), (std::array<std::uint8_t, 3>{6, 5, 4}));
}

// By hand, after the paper: zeros 2; others 2 with the differences +5 (zigzag 10) and -3 (zigzag 5); zeros 1, others 0.
// In groups of three bits, with 8 where there is more, the first group in the highest bits: 2 2 A 1 5 1 0 0.
TEST(RosImage, RvlIsRunsAndDifferences) {
  const std::string data = bytes({0x00, 0x51, 0xA1, 0x22});
  EXPECT_THAT(unpack_rvl(data, 5, "m"), ElementsAre(0, 0, 5, 2, 0));
  EXPECT_THAT(input_error_of([&] { (void)unpack_rvl(data, 3, "m"); }), HasSubstr("more than 3 pixels"));
  EXPECT_THAT(input_error_of([&] { (void)unpack_rvl(data, 6, "m"); }), HasSubstr("m, byte"));
}

TEST(RosImage, InverseDepthsAreUnpacked) {
  // 32FC1 as RVL: depth = a / (number - b) with a = 100, b = 10; one pixel with the number 60 is 2 m away.
  const std::string data =
      bytes({0, 0, 0, 0, 0, 0, 0xC8, 0x42, 0, 0, 0x20, 0x41, 1, 0, 0, 0, 1, 0, 0, 0, 0x00, 0x10, 0x8F, 0x01});
  const RosCompressedImage image{RosHeader{}, "32FC1; compressedDepth rvl", data};
  EXPECT_THAT(std::get<FloatImage>(depth_of(image, "m")).values, ElementsAre(2.0F));
}

RosCameraInfo camera() {
  RosCameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.distortion = {0.1, 0, 0, 0, 0};
  info.k = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  info.p = {400, 0, 300, 0, 0, 410, 200, 0, 0, 0, 1, 0};
  return info;
}

TEST(RosImage, RectifiedImagesHaveTheProjectionMatrix) {
  const Intrinsics raw = intrinsics_of(camera(), false, "m"), rectified = intrinsics_of(camera(), true, "m");
  EXPECT_EQ((std::array{raw.fx, raw.cx}), (std::array{500.0, 320.0}));
  EXPECT_TRUE(raw.is_distorted());
  EXPECT_EQ((std::array{rectified.fx, rectified.cx}), (std::array{400.0, 300.0}));
  EXPECT_FALSE(rectified.is_distorted());
}

TEST(RosImage, PartsAndBinnedPixelsOfTheSensorCount) {
  RosCameraInfo info = camera();
  info.binning_x = info.binning_y = 2;
  info.roi_x = 20;
  info.roi_y = 40;
  info.roi_width = 320;
  info.roi_height = 240;
  const Intrinsics part = intrinsics_of(info, false, "m");
  EXPECT_EQ((std::array{part.fx, part.fy, part.cx, part.cy}), (std::array{250.0, 255.0, 150.0, 100.0}));
  EXPECT_EQ(part.resolution, (Resolution{160, 120}));
  info.k = {};
  EXPECT_THAT(input_error_of([&] { (void)intrinsics_of(info, false, "m"); }), HasSubstr("K is not filled in"));
}

TEST(RosImage, CloudsMayBeOfDoublesInEitherByteOrder) {
  RosPointCloud cloud{RosHeader{}, 1, 2, {{"z", 8, 8}, {"x", 0, 7}, {"y", 4, 7}}, true, 16, 32, {}};
  const std::string point = bytes({0x3F, 0x80, 0, 0, 0x40, 0, 0, 0, 0x40, 8, 0, 0, 0, 0, 0, 0});
  const std::string data = point + std::string(16, '\0');  // the second one was not measured
  cloud.data = data;
  const CloudFile file = cloud_of(cloud, "m");
  ASSERT_EQ(file.cloud.size(), 1U);
  EXPECT_EQ(file.cloud.points[0], Vec3(1, 2, 3));
  cloud.width = 3;
  EXPECT_EQ(input_error_of([&] { (void)cloud_of(cloud, "m"); }), "m: has 32 bytes of points, must have 48");
  cloud.fields[0].offset = 9;
  EXPECT_EQ(input_error_of([&] { (void)cloud_of(cloud, "m"); }), "m: field z ends beyond the 16 bytes of a point");
  cloud.fields[0].name = "intensity";
  EXPECT_EQ(input_error_of([&] { (void)cloud_of(cloud, "m"); }), "m: a cloud without the fields x, y and z");
}

}  // namespace
}  // namespace vantage
