#include "vantage/experiments/run_outcome.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

RunOutcome outcome() {
  RunOutcome result;
  result.numbers = {{"views", 3}, {"share", 0.1}, {"unknown", NAN}};
  result.lists = {{"coverage", {0.25, 1.0 / 3, NAN}}, {"empty", {}}};
  result.texts = {{"stop_reason", "nothing <left> \"to\" see"}};
  result.times = {{"plan", {1.5, 2.25}}};
  return result;
}

TEST(RunOutcome, ComesBackFromJsonToTheLastBit) {
  const RunOutcome before = outcome();
  const RunOutcome after = outcome_from_json(nlohmann::json::parse(outcome_json(before).dump()),
                                             nlohmann::json::parse(times_json(before).dump()), "file");
  EXPECT_EQ(after.number("views"), 3);
  EXPECT_EQ(after.number("share"), 0.1);
  EXPECT_TRUE(std::isnan(after.number("unknown")));
  ASSERT_EQ(after.list("coverage").size(), 3U);
  EXPECT_EQ(after.list("coverage")[1], 1.0 / 3);
  EXPECT_TRUE(std::isnan(after.list("coverage")[2]));
  EXPECT_TRUE(after.list("empty").empty());
  EXPECT_EQ(after.texts, before.texts);
  EXPECT_EQ(after.times, before.times);
}

TEST(RunOutcome, TimesStandApart) { EXPECT_EQ(outcome_json(outcome()).dump().find("plan"), std::string::npos); }

TEST(RunOutcome, SaysWhatItHasWhereANameIsUnknown) {
  try {
    (void)outcome().number("vews");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a run has no number 'vews'; it has: share, unknown, views");
  }
}

TEST(RunOutcome, RefusesJsonOfAnotherShape) {
  const nlohmann::json times = nlohmann::json::object();
  for (const char* text :
       {"[]", R"({"numbers":{}})", R"({"numbers":{"a":"b"},"texts":{},"lists":{}})",
        R"({"numbers":{},"texts":{"a":1},"lists":{}})", R"({"numbers":{},"texts":{},"lists":{"a":1}})"})
    EXPECT_THROW((void)outcome_from_json(nlohmann::json::parse(text), times, "file"), InputError) << text;
}

TEST(RunOutcome, CarriesTheLastValueForward) {
  RunOutcome run;
  run.lists["coverage"] = {0.5, 0.75};
  EXPECT_EQ(after_scan(run, "coverage", 1), 0.5);
  EXPECT_EQ(after_scan(run, "coverage", 2), 0.75);
  EXPECT_EQ(after_scan(run, "coverage", 9), 0.75);
  EXPECT_THROW((void)after_scan(run, "coverage", 0), InputError);
}

}  // namespace
}  // namespace vantage
