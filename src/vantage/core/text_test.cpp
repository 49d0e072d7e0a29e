#include "vantage/core/text.hpp"

#include <gmock/gmock.h>

namespace vantage {
namespace {

using testing::ElementsAre;

TEST(Split, KeepsEmptyParts) {
  EXPECT_THAT(split("cube:17:4.1", ':'), ElementsAre("cube", "17", "4.1"));
  EXPECT_THAT(split("", ','), ElementsAre(""));
  EXPECT_THAT(split(",a,", ','), ElementsAre("", "a", ""));
}

}  // namespace
}  // namespace vantage
