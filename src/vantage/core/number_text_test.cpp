#include "vantage/core/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace vantage {
namespace {

TEST(NumberText, IsTheWholeText) {
  EXPECT_EQ(number_from<double>("1.5"), 1.5);
  EXPECT_EQ(number_from<double>("+1e3"), 1000);
  EXPECT_EQ(number_from<double>("-2"), -2);
  for (const char* text : {"", " 1", "1 ", "1,5", "0x10", "1.5m", "+", "+-1", "++1", "1e999"})
    EXPECT_EQ(number_from<double>(text), std::nullopt) << text;
  EXPECT_EQ(number_from<double>("1e-999"), 0);
  EXPECT_TRUE(std::isinf(number_from<double>("inf").value_or(0)));
}

TEST(NumberText, WholeNumbersStayInTheirRange) {
  EXPECT_EQ(number_from<int>("-17"), -17);
  EXPECT_EQ(number_from<std::uint8_t>("255"), 255);
  EXPECT_EQ(number_from<std::uint8_t>("256"), std::nullopt);
  EXPECT_EQ(number_from<int>("1.0"), std::nullopt);
}

TEST(NumberText, ReadsTheDigitsThatATextBeginsWith) {
  EXPECT_EQ(leading_number("12, more"), 12);
  EXPECT_EQ(leading_number("7"), 7);
  for (const char* text : {"", "x1", "-1", "+1", "99999999999"}) EXPECT_EQ(leading_number(text), 0) << text;
}

}  // namespace
}  // namespace vantage
