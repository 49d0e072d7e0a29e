#include "vantage/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/limited_memory.hpp"

namespace vantage {
namespace {

TEST(Error, ConcatWritesPartsAsTheyPrint) {
  EXPECT_EQ(concat("max_depth = ", -1.5, " m, ", 3, 'x', 4), "max_depth = -1.5 m, 3x4");
}

TEST(Error, ConcatKeepsTwelveDigits) { EXPECT_EQ(concat(123456.789012), "123456.789012"); }

TEST(Error, ConcatThrowsWhereMemoryIsShortInsteadOfCuttingTheTextOff) {
  const std::string name(1000, 'n');
  test::refuses_memory = [](std::size_t size) { return size > 600; };
  EXPECT_THROW((void)concat("the file ", name, " is damaged"), std::bad_alloc);
  test::refuses_memory = nullptr;
  EXPECT_EQ(concat("the file ", name, " is damaged").size(), 1000U + 20);
}

TEST(Error, RequireThrowsInputErrorWithTheText) {
  EXPECT_NO_THROW(require(true, "never"));
  try {
    require(false, "radius = ", 0, " m: must be positive");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "radius = 0 m: must be positive");
  }
}

TEST(Error, MisuseIsAlsoAnError) { EXPECT_THROW(throw InputError("x"), Error); }

}  // namespace
}  // namespace vantage
