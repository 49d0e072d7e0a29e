#include "vantage/recordings/pose_match.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/core/geometry.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

Pose at(double x) {
  Pose pose = Pose::Identity();
  pose.translation().x() = x;
  return pose;
}

/// Where the pose of each frame is, -1 for none.
std::vector<double> places(const MatchedPoses& matched) {
  std::vector<double> result;
  for (const auto& pose : matched.poses) result.push_back(pose ? pose->translation().x() : -1);
  return result;
}

std::vector<FrameKey> keys(const std::vector<std::string>& names) {
  std::vector<FrameKey> result;
  for (const std::string& name : names) result.push_back({name, std::nullopt});
  return result;
}

TEST(PoseMatch, TimesFindTheNearestPoseOfAnyOrder) {
  const PoseList list{"a", {{2.0, std::nullopt, at(2)}, {1.0, std::nullopt, at(1)}, {1.01, std::nullopt, at(3)}}};
  const MatchedPoses matched = match_poses(list, keys({"0.99", "1.006", "1.95"}), PoseMatch::time, "a.txt");
  EXPECT_EQ(places(matched), (std::vector<double>{1, 3, -1}));
  EXPECT_EQ(matched.how, "2 matched within 20 ms");
  EXPECT_EQ(matched.why_not[2], "has no pose within 0.02 s");
}

TEST(PoseMatch, WholeNumbersGoByOrderWhereCountsAgreeAndByNumberWhereNot) {
  const PoseList timed{"a", {{100.5, std::nullopt, at(0)}, {101.5, std::nullopt, at(1)}}};
  EXPECT_EQ(places(match_poses(timed, keys({"7", "8"}), PoseMatch::automatic, "a")), (std::vector<double>{0, 1}));
  const PoseList numbered{"a", {{std::nullopt, 5, at(5)}, {std::nullopt, 7, at(7)}, {std::nullopt, 8, at(8)}}};
  const MatchedPoses by_number = match_poses(numbered, keys({"f-7", "f-8", "f-9", "g"}), PoseMatch::automatic, "a");
  EXPECT_EQ(places(by_number), (std::vector<double>{7, 8, -1, -1}));
  EXPECT_EQ(by_number.why_not[2], "has no pose of number 9");
  EXPECT_EQ(by_number.why_not[3], "has no number in its name");
  const PoseList plain{"a", {{std::nullopt, std::nullopt, at(0)}, {std::nullopt, std::nullopt, at(1)}, {}}};
  EXPECT_EQ(places(match_poses(plain, keys({"000001", "000002"}), PoseMatch::automatic, "a")),
            (std::vector<double>{1, -1}));
}

TEST(PoseMatch, NothingThatFitsIsAnError) {
  const PoseList timed{"a", {{100.5, std::nullopt, at(0)}, {101.5, std::nullopt, at(1)}}};
  EXPECT_THAT(input_error_of([&] {
                (void)match_poses(timed, keys({"a", "b", "c"}), PoseMatch::automatic, "a.txt");
              }),
              HasSubstr("a.txt: has 2 poses for 3 scans"));
  const PoseList plain{"a", {{std::nullopt, std::nullopt, at(0)}}};
  EXPECT_THAT(input_error_of([&] { (void)match_poses(plain, keys({"1.5"}), PoseMatch::time, "a.txt"); }),
              HasSubstr("a.txt: has no times; --match order or name"));
}

TEST(PoseMatch, TheLastNumberOfANameCounts) {
  EXPECT_EQ(number_in("cam0-frame_000150"), 150);
  EXPECT_EQ(number_in("frame150b"), 150);
  EXPECT_FALSE(number_in("frame").has_value());
}

}  // namespace
}  // namespace vantage
