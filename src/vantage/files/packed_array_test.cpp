#include "vantage/files/packed_array.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

std::string encoded(const std::string& text) {
  return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// Independent of the encoder: looks every digit up in the alphabet.
std::vector<std::uint8_t> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<unsigned>(digits.find(c));
    if ((count += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(count -= 8) & 255U));
  }
  return bytes;
}

std::vector<std::uint8_t> stored_bytes(const nlohmann::ordered_json& packed, std::size_t size) {
  const std::vector<std::uint8_t> stream = decoded(packed["data"].get<std::string>());
  std::vector<std::uint8_t> bytes(size);
  uLongf length = size;
  EXPECT_EQ(uncompress(bytes.data(), &length, stream.data(), stream.size()), Z_OK);
  EXPECT_EQ(length, size);
  return bytes;
}

TEST(PackedArray, EncodesTheExamplesOfRfc4648) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(PackedArray, StoresPlainNumbersLittleEndian) {
  const std::vector<std::uint16_t> values{1, 0x1234, 0xffff, 0};
  const auto packed = packed_array<std::uint16_t>(values, 2);
  EXPECT_EQ(packed["type"], "u16");
  EXPECT_EQ(packed["shape"], nlohmann::ordered_json::array({2, 2}));
  EXPECT_EQ(packed["delta"], false);
  EXPECT_EQ(stored_bytes(packed, 8), (std::vector<std::uint8_t>{1, 0, 0x34, 0x12, 0xff, 0xff, 0, 0}));
}

TEST(PackedArray, StoresDifferencesAsBytePlanesModulo) {
  // Rows (10, 300), (12, 299), (5, 299): differences (10, 300), (2, -1), (-7, 0) modulo 65536.
  const std::vector<std::uint16_t> values{10, 300, 12, 299, 5, 299};
  const auto packed = packed_array<std::uint16_t>(values, 2, PackedRows::differences);
  EXPECT_EQ(packed["delta"], true);
  EXPECT_EQ(stored_bytes(packed, 12), (std::vector<std::uint8_t>{10, 2, 249, 0, 0, 255, 44, 255, 0, 1, 255, 0}));
}

TEST(PackedArray, TakesNoNumbers) {
  const auto packed = packed_array<float>({});
  EXPECT_EQ(packed["shape"], nlohmann::ordered_json::array({0}));
  EXPECT_TRUE(stored_bytes(packed, 0).empty());
}

TEST(PackedArray, RefusesHalfRowsAndDifferencesOfFractions) {
  const std::vector<float> values{1, 2, 3};
  EXPECT_THROW((void)packed_array<float>(values, 2), InputError);
  EXPECT_THROW((void)packed_array<float>(values, 1, PackedRows::differences), InputError);
}

}  // namespace
}  // namespace vantage
