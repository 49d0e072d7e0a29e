#include "cost_note.hpp"

#include <gmock/gmock.h>

#include "vantage/core/error.hpp"

namespace vantage::app {
namespace {

using testing::HasSubstr;

TEST(CostNote, SpeaksUpWhereItTakesLong) {
  EXPECT_EQ(cost_note(80, {320, 320}), "");
  EXPECT_EQ(cost_note(1280, {640, 480}), "");
  EXPECT_THAT(cost_note(80, {16384, 16384}), HasSubstr("80 views of 16384x16384 rays are 2.1e+10 rays"));
  EXPECT_THAT(cost_note(327'680, {320, 320}), HasSubstr("3.4e+10 rays"));
  EXPECT_THROW((void)cost_note(327'680, {16384, 16384}), InputError);
}

}  // namespace
}  // namespace vantage::app
