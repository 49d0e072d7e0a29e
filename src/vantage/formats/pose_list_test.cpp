#include "vantage/formats/pose_list.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
  return input_error_of([&] { (void)parse_pose_list(text, "a.txt"); });
}

TEST(PoseList, IsRecognisedByItsLines) {
  const PoseList tum = parse_pose_list("# t x y z\n1.5 1 2 3 0 0 0 1\n1.6,nan,0,0,0,0,0,1\n", "a");
  EXPECT_EQ(tum.kind, "TUM trajectory");
  ASSERT_EQ(tum.poses.size(), 2U);
  EXPECT_EQ(tum.poses[0].time, 1.5);
  EXPECT_EQ(tum.poses[0].world_from_sensor->translation(), Vec3(1, 2, 3));
  EXPECT_FALSE(tum.poses[1].world_from_sensor.has_value());
  const PoseList kitti = parse_pose_list("1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 0 0 1 0 0 0 0 1 0\n", "a");
  EXPECT_EQ(kitti.kind, "KITTI trajectory");
  EXPECT_EQ(kitti.poses[0].world_from_sensor->translation(), Vec3(4, 5, 6));
  EXPECT_EQ(parse_pose_list("1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n", "a").poses.size(), 1U);
  const PoseList log =
      parse_pose_list("3 3 4\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n7 7 8\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "a");
  EXPECT_EQ(log.kind, "Open3D log");
  ASSERT_EQ(log.poses.size(), 2U);
  EXPECT_EQ(log.poses[1].number, 7);
  const PoseList threes = parse_pose_list("1 0 0 1\n0 1 0 2\n0 0 1 3\n\n1 0 0 4\n0 1 0 5\n0 0 1 6\n", "a");
  EXPECT_EQ(threes.kind, "list of matrices");
  ASSERT_EQ(threes.poses.size(), 2U);
  EXPECT_EQ(threes.poses[1].world_from_sensor->translation(), Vec3(4, 5, 6));
}

TEST(PoseList, WhatIsWrongIsNamed) {
  EXPECT_THAT(error_of(""), HasSubstr("a.txt: has no pose"));
  EXPECT_THAT(error_of(", ,\n"), HasSubstr("a.txt, line 1: has 0 numbers: must be 8"));
  EXPECT_THAT(error_of("1 2 3 4 5\n"), HasSubstr("a.txt, line 1: has 5 numbers: must be 8"));
  EXPECT_THAT(error_of("1.5 1 2 3 0 0 0 2\n"), HasSubstr("a.txt: pose 0: the quaternion has length 2"));
  EXPECT_THAT(error_of("1.5 1 2 x 0 0 0 1\n"), HasSubstr("a.txt, line 1: number 4 = 'x': must be a number"));
  EXPECT_THAT(error_of("1 0 0 1\n0 1 0 2\n5 5 6\n"), HasSubstr("a.txt, line 3: a matrix of 2 rows ends here"));
  EXPECT_THAT(error_of("1.5 1 2 3 0 0 0 1\n1 0 0 4 0 1 0 5 0 0 1 6\n"),
              HasSubstr("line 2: a line of a KITTI trajectory, those before are of a TUM trajectory"));
  EXPECT_THAT(error_of("-1 0 0 4 0 1 0 5 0 0 1 6\n"), HasSubstr("it is mirrored"));
  EXPECT_THAT(error_of("{\"a\": 1}"), HasSubstr("a.txt: is no list of poses; must be an Open3D camera trajectory"));
  EXPECT_THAT(error_of("{\"nodes\": [{\"pose\": [1]}]}"),
              HasSubstr("a.txt: nodes 0: pose: must be a list of 16 numbers"));
}

TEST(PoseList, DamagedFilesAreReadOrRefused) {
  for (const std::string text :
       {"1.5 1 2 3 0 0 0 1\n2.5 1 2 3 0 0 0 1\n", "3 3 4\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n",
        "{\"nodes\": [{\"pose\": [1,0,0,0,0,1,0,0,0,0,1,0,4,5,6,1]}]}"}) {
    const FuzzCount count = read_damaged(
        text, 1500, [](const std::string& damaged) { ASSERT_FALSE(parse_pose_list(damaged, "a").poses.empty()); });
    EXPECT_EQ(count.accepted + count.refused, 1500);
    EXPECT_GT(count.refused, 200);
  }
}

}  // namespace
}  // namespace vantage
