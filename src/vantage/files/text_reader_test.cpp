#include "vantage/files/text_reader.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

TEST(Numbers, AreReadAsAWhole) {
  EXPECT_EQ(to_double("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(to_double("+2"), 2);
  EXPECT_EQ(to_double("1e-999"), 0);
  EXPECT_TRUE(std::isnan(to_double("nan").value()));
  for (const char* bad : {"", " 1", "1 ", "1,5", "0x10", "1e", "+-1", "++1", "+", "1e999", "one"}) {
    EXPECT_EQ(to_double(bad), std::nullopt) << bad;
  }
  EXPECT_EQ(to_integer("-12"), -12);
  EXPECT_EQ(to_integer("1.0"), std::nullopt);
  EXPECT_EQ(to_integer("9223372036854775808"), std::nullopt);
  EXPECT_EQ(to_unsigned("18446744073709551615"), 18446744073709551615U);
  EXPECT_EQ(to_unsigned("-1"), std::nullopt);
}

TEST(InQuotes, ShowsWhatIsThereInOneShortLine) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes(std::string_view("a\0\n\xff", 4)), "'a\\x00\\x0a\\xff'");
  EXPECT_EQ(in_quotes(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(TextReader, WalksOverLinesAndWordsOfAnySystem) {
  TextReader reader("one  two\r\n\n \t\n 3.5 -4 7\nlast", "file");
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.word(), "one");
  EXPECT_FALSE(reader.at_end_of_line());
  EXPECT_EQ(reader.word(), "two");
  EXPECT_TRUE(reader.at_end_of_line());
  EXPECT_EQ(reader.word(), "");
  ASSERT_TRUE(reader.next_line_with_words());
  EXPECT_EQ(reader.number("x"), 3.5);
  EXPECT_EQ(reader.integer("y"), -4);
  EXPECT_EQ(reader.count("z"), 7U);
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.rest_of_line(), "last");
  EXPECT_FALSE(reader.next_line());
  EXPECT_FALSE(reader.next_line_with_words());
}

TEST(TextReader, ErrorsNameThePlaceTheFieldAndTheValue) {
  const auto error_with = [](std::string_view text, auto read) {
    return input_error_of([&] {
      TextReader reader(text, "a.txt");
      reader.next_line();
      reader.next_line();
      read(reader);
    });
  };
  EXPECT_EQ(error_with("\nabc", [](TextReader& r) { (void)r.number("x"); }),
            "a.txt, line 2: x = 'abc': must be a number");
  EXPECT_EQ(error_with("\n", [](TextReader& r) { (void)r.number("x"); }), "a.txt, line 1: x is missing");
  EXPECT_EQ(error_with("\nnan", [](TextReader& r) { (void)r.finite_number("x"); }),
            "a.txt, line 2: x = nan: must be a finite number");
  EXPECT_EQ(error_with("\n1.5", [](TextReader& r) { (void)r.integer("n"); }),
            "a.txt, line 2: n = '1.5': must be a whole number");
  EXPECT_EQ(error_with("\n-1", [](TextReader& r) { (void)r.count("n"); }),
            "a.txt, line 2: n = '-1': must be a whole number, not negative");
}

TEST(TextReader, AByteOrderMarkIsNoPartOfTheFirstWord) {
  TextReader reader("\xef\xbb\xbfv 1\n", "a.obj");
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.word(), "v");
}

TEST(AsUtf8, KeepsCharactersAndSpellsOtherBytes) {
  EXPECT_EQ(as_utf8("caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"), "caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(as_utf8("caf\xe9"), "caf\\xe9");
  EXPECT_EQ(as_utf8("\xc0\x80"), "\\xc0\\x80") << "longer than needed";
  EXPECT_EQ(as_utf8("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a surrogate pair";
  EXPECT_EQ(as_utf8("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last character";
  EXPECT_EQ(as_utf8("\xe2\x82"), "\\xe2\\x82") << "cut off";
}

}  // namespace
}  // namespace vantage
