#include "vantage/report/picture.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include "vantage/core/error.hpp"
#include "vantage/report/badge.hpp"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

Picture checkered(int width, int height) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {x * 40, y * 50, (x + y) % 2 * 255})
        picture.rgb.push_back(static_cast<std::uint8_t>(value));
  return picture;
}

TEST(Picture, ComesBackFromItsPngBytes) {
  const Picture picture = checkered(5, 3);
  const std::string bytes = png_bytes(picture);
  EXPECT_THAT(bytes, StartsWith("\x89PNG\r\n\x1a\n"));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.width, 5U);
  EXPECT_EQ(image.height, 3U);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr), 0);
  EXPECT_EQ(back, picture.rgb);
  EXPECT_EQ(png_bytes(picture), bytes);
}

TEST(Picture, RefusesSizesThatDoNotAgree) {
  EXPECT_THAT(
      [] {
        static_cast<void>(png_bytes({2, 2, {1, 2, 3}}));
      },
      ThrowsMessage<InputError>(HasSubstr("holds 3 bytes: must hold 12")));
  EXPECT_THAT(
      [] {
        static_cast<void>(png_bytes({0, 2, {}}));
      },
      ThrowsMessage<InputError>(HasSubstr("both sides must be positive")));
}

TEST(Picture, IsADataAddressOfItsPngBytes) {
  const Picture picture = checkered(4, 4);
  // "\x89PNG\r\n" in base64 begins iVBORw0K.
  EXPECT_THAT(png_data_uri(picture), StartsWith("data:image/png;base64,iVBORw0K"));
  EXPECT_EQ(png_data_uri(picture).size(), 22 + (png_bytes(picture).size() + 2) / 3 * 4);
}

TEST(Badge, FillsItsCircleAndIsCutAtTheBorder) {
  Picture picture{40, 40, std::vector<std::uint8_t>(4800, 10)};
  draw_badge(picture, 20, 20, 8, 11, palette::blue);
  EXPECT_THAT(picture.at(14, 20), ElementsAre(0x00, 0x72, 0xB2));  // within the circle, beside the digits
  EXPECT_THAT(picture.at(11, 20), ElementsAre(255, 255, 255));     // the rim
  EXPECT_THAT(picture.at(20, 8), ElementsAre(10, 10, 10));         // outside
  const auto before = picture.rgb;
  draw_badge(picture, -50, 300, 8, 3, palette::blue);
  EXPECT_EQ(picture.rgb, before);
  draw_badge(picture, 0, 0, 8, 3, palette::blue);
  EXPECT_NE(picture.rgb, before);
}

}  // namespace
}  // namespace vantage
