#include "vantage/formats/pose_file.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

const std::string quarter_turn = "0 -1 0 1\n1 0 0 2\n\n0 0 1 3\n0 0 0 1\n";  // about z

TEST(PoseFile, TextJsonAndTrajectoryAgree) {
  const Pose expected = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(radians(90), Vec3::UnitZ());
  EXPECT_TRUE(parse_pose_text(quarter_turn, "a").isApprox(expected));
  const std::string h = "0.70710678";
  for (const std::string& text :
       {R"({"position": [1, 2, 3], "orientation": [0, 0, )" + h + ", " + h + "]}",
        R"({"position": {"x": 1, "y": 2, "z": 3}, "orientation": {"x": 0, "y": 0, "z": )" + h + R"(, "w": )" + h + "}}",
        R"({"translation": [1, 2, 3], "rotation": [0, 0, )" + h + ", " + h + "]}",
        std::string(R"({"matrix": [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]})")}) {
    EXPECT_TRUE(parse_pose_json(text, "a").isApprox(expected)) << text;
  }
  const auto trajectory =
      parse_trajectory("# t x y z qx qy qz qw\n1.5 0 0 0 0 0 0 1\n2 1 2 3 0 0 " + h + " " + h + "\n", "a");
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].time, 1.5);
  EXPECT_TRUE(trajectory[0].pose.isApprox(Pose::Identity()));
  EXPECT_TRUE(trajectory[1].pose.isApprox(expected));
}

TEST(PoseFile, WhatIsWrittenIsReadToTheLastBit) {
  const TestFolder folder;
  Random random(3);
  std::vector<StampedPose> trajectory;
  for (int i = 0; i < 20; ++i) {
    Pose pose = look_at(random.normal3(), random.normal3());
    write_pose(folder / "a.pose.txt", pose);
    EXPECT_EQ(read_pose(folder / "a.pose.txt").matrix(), pose.matrix());
    trajectory.push_back({i + 0.1, pose});
  }
  write_trajectory(folder / "poses.tum", trajectory);
  const auto again = read_trajectory(folder / "poses.tum");
  ASSERT_EQ(again.size(), 20U);
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].time, trajectory[i].time);
    EXPECT_TRUE(again[i].pose.isApprox(trajectory[i].pose, 1e-14));
  }
}

TEST(PoseFile, BadTextIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& text) {
    return input_error_of([&] { (void)parse_pose_text(text, "a.txt"); });
  };
  EXPECT_EQ(error(""), "a.txt: has 0 rows, must be 4 rows of 4 numbers");
  EXPECT_EQ(error("1 0 0 0\n0 1 0 0\n"), "a.txt: has 2 rows, must be 4 rows of 4 numbers");
  EXPECT_EQ(error("1 0 0\n"), "a.txt, line 1: number 4 of row 1 is missing");
  EXPECT_EQ(error("1 0 zero 0\n"), "a.txt, line 1: number 3 of row 1 = 'zero': must be a number");
  EXPECT_EQ(error("1 0 0 0 7\n"), "a.txt, line 1: '7' is a fifth number, must be 4 per row");
  EXPECT_EQ(error(quarter_turn + "0 0 0 1\n"), "a.txt, line 6: a fifth row, must be 4 rows of 4 numbers");
  EXPECT_THAT(error("nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"),
              HasSubstr("a.txt: the pose has an entry that is not a finite number"));
  EXPECT_THAT(error("-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"), HasSubstr("mirrored"));
  EXPECT_THAT(error("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n"), HasSubstr("not orthonormal"));
  EXPECT_THAT(error("1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n"), HasSubstr("the last row is 1 2 3 1"));
}

TEST(PoseFile, BadJsonIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& text) {
    return input_error_of([&] { (void)parse_pose_json(text, "a.json"); });
  };
  EXPECT_THAT(error(""), HasSubstr("a.json: parse error at line 1, column 1"));
  EXPECT_THAT(error("{\n  \"position\": [1, 2 3]}"), HasSubstr("a.json: parse error at line 2, column 21"));
  EXPECT_THAT(error("[1, 2, 3]"), HasSubstr("must be a JSON object"));
  EXPECT_EQ(error("{}"), "a.json: has no 'position'");
  EXPECT_EQ(error(R"({"position": [1, 2, 3]})"), "a.json: has no 'orientation'");
  EXPECT_THAT(error(R"({"position": [1, 2], "orientation": [0, 0, 0, 1]})"),
              HasSubstr("a.json: position: must be a list of 3 numbers"));
  EXPECT_EQ(error(R"({"position": {"x": 1, "y": 2}, "orientation": [0, 0, 0, 1]})"), "a.json: position: has no 'z'");
  EXPECT_EQ(error(R"({"position": [1, "2", 3], "orientation": [0, 0, 0, 1]})"),
            "a.json: position.y: must be a number, is string");
  EXPECT_EQ(error(R"({"position": [1, 2, 3], "orientation": [0, 0, 0, 0]})"),
            "a.json: the quaternion has length 0, must be 1");
  EXPECT_THAT(error(R"({"matrix": [[1, 0, 0, 0]]})"), HasSubstr("must be a list of 4 rows"));
  EXPECT_THAT(error(R"({"position": [1, 2, 1e999], "orientation": [0, 0, 0, 1]})"), HasSubstr("a.json"));
  EXPECT_THAT(error(std::string(100'000, '[')), HasSubstr("a.json"));
  EXPECT_EQ(error(std::string(200, '[') + std::string(200, ']')), "a.json: is nested deeper than 100 levels");
}

TEST(PoseFile, BadTrajectoriesAreRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& text) {
    return input_error_of([&] { (void)parse_trajectory(text, "a.tum"); });
  };
  EXPECT_THAT(error("# nothing\n"), HasSubstr("a.tum: has no pose"));
  EXPECT_EQ(error("1 0 0 0 0 0 0\n"), "a.tum, line 1: qw is missing");
  EXPECT_EQ(error("1 0 0 nan 0 0 0 1\n"), "a.tum, line 1: tz = nan: must be a finite number");
  EXPECT_EQ(error("1 0 0 0 0 0 0 1 9\n"), "a.tum, line 1: '9' is a ninth number, must be 8 per line");
  EXPECT_EQ(error("1 0 0 0 0 0 0 2\n"), "a.tum: pose 0: the quaternion has length 2, must be 1");
  EXPECT_EQ(error("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
            "a.tum, line 2: timestamp 1: must be later than 2 of the line before");
}

TEST(PoseFile, DamagedFilesAreReadOrRefused) {
  const auto damage = [](const std::string& bytes, auto parse) {
    const FuzzCount count = read_damaged(bytes, 3000, parse);
    EXPECT_EQ(count.accepted + count.refused, 3000);
    EXPECT_GT(count.refused, 500);
  };
  damage(quarter_turn, [](const std::string& text) { ASSERT_TRUE(parse_pose_text(text, "a").matrix().allFinite()); });
  damage(R"({"position": [1, 2, 3], "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}})",
         [](const std::string& text) { ASSERT_TRUE(parse_pose_json(text, "a").matrix().allFinite()); });
  damage("1.5 0 0 0 0 0 0 1\n2 1 2 3 0 0 1 0\n",
         [](const std::string& text) { ASSERT_FALSE(parse_trajectory(text, "a").empty()); });
}

}  // namespace
}  // namespace vantage
