#include "vantage/files/plain_text.hpp"

#include <gmock/gmock.h>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

TEST(PlainText, KnowsUtf8) {
  for (const char* good : {"", "frame 7",
                           "Gr\xc3\xb6\xc3\x9f"
                           "e",
                           "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(is_utf8(good)) << good;
  // Latin-1; a lone continuation; cut off; overlong (2, 3, 4 bytes); a surrogate; beyond U+10FFFF; bytes that never
  // come.
  for (const char* bad :
       {"Gr\xf6\xdf"
        "e",
        "\x80", "\xc3", "\xe2\x82", "\xf0\x9f\x98", "\xc0\xaf", "\xc1\xbf", "\xe0\x80\xaf", "\xf0\x80\x80\xaf",
        "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "a\xe2(\xa1"})
    EXPECT_FALSE(is_utf8(bad)) << printable(bad);
}

TEST(PlainText, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(printable("Gr\xc3\xb6\xc3\x9f"
                      "e 7 \xe2\x82\xac"),
            "Gr\xc3\xb6\xc3\x9f"
            "e 7 \xe2\x82\xac");
  EXPECT_EQ(printable("\x1b[2J\nview 5\r\t\x7f"), "\\x1b[2J\\x0aview 5\\x0d\\x09\\x7f");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31m"),
            "a\\xc2\\x9b31m")
      << "CSI of C1";
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a\\xe2\\x80\\xaeb")
      << "right-to-left override";
  EXPECT_EQ(printable("Gr\xf6"), "Gr\\xf6");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

TEST(PlainText, RefusesTheRest) {
  EXPECT_NO_THROW(require_plain_text("frame 7 (\xc3\xa4)", "key"));
  EXPECT_THROW(require_plain_text("a\nb", "key"), InputError);
  try {
    require_plain_text(
        "Gr\xf6\xdf"
        "e",
        "field 'key'");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "field 'key': is not UTF-8: Gr\\xf6\\xdfe");
  }
}

}  // namespace
}  // namespace vantage
