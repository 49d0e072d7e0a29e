#include "vantage/formats/png16.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <zlib.h>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

std::string number(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> static_cast<unsigned>(shift));
  return bytes;
}

std::string chunk(const std::string& kind, const std::string& data) {
  const std::string named = kind + data;
  const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
  return number(static_cast<std::uint32_t>(data.size())) + named + number(static_cast<std::uint32_t>(sum));
}

/// A text of a PNG that unpacks to `size` blanks.
std::string packed_text(std::size_t size) {
  const std::string blanks(size, ' ');
  std::string packed(::compressBound(static_cast<uLong>(size)), '\0');
  auto length = static_cast<uLongf>(packed.size());
  (void)::compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(blanks.data()),
                   static_cast<uLong>(size));
  packed.resize(length);
  return chunk("zTXt", std::string("Comment") + '\0' + '\0' + packed);
}

/// The most memory that this process has had, megabytes.
double peak() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1000;
}

TEST(Png, TextsAreNotUnpacked) {
  std::string png = encode_png16({{2, 1}, {7, 9}});
  const std::size_t end_of_header = 8 + 25;
  std::string texts;
  const std::string text = packed_text(7'000'000);
  for (int i = 0; i < 100; ++i) texts += text;
  png.insert(end_of_header, texts);
  const double before = peak();
  EXPECT_THAT(decode_png16(png, "a.png").values, testing::ElementsAre(7, 9));
  EXPECT_LT(peak() - before, 100) << "700 MB of text";
}

TEST(Png, TheNumberOfPixelsIsAskedBeforeMemoryIsTaken) {
  const std::string png = encode_png16({{3, 2}, {1, 2, 3, 4, 5, 6}});
  EXPECT_THAT(decode_png16(png, "a.png", 6).values, testing::SizeIs(6));
  EXPECT_THAT(input_error_of([&] { (void)decode_png16(png, "a.png", 5); }),
              testing::HasSubstr("a.png: has 3x2 pixels; must have at most 5"));
}

}  // namespace
}  // namespace vantage
