#include "vantage/recordings/transform_tree.hpp"

#include <gmock/gmock.h>

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t ms = 1'000'000;

RosPose transform(const std::string& parent, const std::string& child, const Vec3& place, double turn = 0) {
  RosPose pose{{0, parent}, child, Pose::Identity()};
  pose.parent_from_child.translation() = place;
  pose.parent_from_child.linear() = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  return pose;
}

/// world -> hand moves along x from 0 at 1 s to 1 m at 2 s and turns by 0.8 rad; the camera is 0.5 m above the hand.
TransformTree moving_hand() {
  TransformTree tree;
  for (int i = 0; i <= 10; ++i)
    tree.add(transform("world", "hand", Vec3(0.1 * i, 0, 0), 0.08 * i), (1000 + 100 * i) * ms);
  tree.add_static(transform("hand", "camera", Vec3(0, 0, 0.5)));
  tree.finish();
  return tree;
}

TEST(TransformTree, ChainsGoThroughTheCommonParent) {
  TransformTree tree = moving_hand();
  const Pose pose = tree.a_from_b("world", "camera", 1300 * ms).pose.value();
  EXPECT_TRUE(pose.translation().isApprox(Vec3(0.3, 0, 0.5), 1e-12));
  const Pose inverse = tree.a_from_b("camera", "world", 1300 * ms).pose.value();
  EXPECT_TRUE((pose * inverse).isApprox(Pose::Identity(), 1e-12));
  EXPECT_EQ(tree.root_of("camera"), "world");
  EXPECT_TRUE(tree.moves("camera"));
}

TEST(TransformTree, BetweenSamplesPositionIsLinearAndRotationSlerp) {
  const TransformTree tree = moving_hand();
  const Pose pose = tree.a_from_b("world", "hand", 1325 * ms).pose.value();
  EXPECT_TRUE(pose.translation().isApprox(Vec3(0.325, 0, 0), 1e-12));
  EXPECT_NEAR(rotation_angle(pose.linear(), Mat3::Identity()), 0.26, 1e-12);
}

TEST(TransformTree, BeyondTheSamplesThereIsNoPoseButForTwentyMilliseconds) {
  const TransformTree tree = moving_hand();
  EXPECT_TRUE(tree.a_from_b("world", "hand", 981 * ms).pose.has_value());
  EXPECT_EQ(tree.a_from_b("world", "camera", 900 * ms).reason, "/tf of hand: the first pose is 0.100 s later");
  EXPECT_EQ(tree.a_from_b("world", "camera", 2500 * ms).reason, "/tf of hand: the last pose is 0.500 s earlier");
}

TEST(TransformTree, AGapCountsOnlyWhereTheSensorMovedInIt) {
  PoseTrack track;
  for (int i = 0; i < 10; ++i) track.add(i * 10 * ms, 0, Pose::Identity());
  track.add(2000 * ms, 0, Pose::Identity());
  Pose moved = Pose::Identity();
  moved.translation().x() = 0.2;
  track.add(4000 * ms, 0, moved);
  track.finish();
  EXPECT_TRUE(track.at(1000 * ms).first.has_value());
  EXPECT_EQ(track.at(3000 * ms).second, "there is no pose for 2.000 s around it");
}

TEST(TransformTree, CirclesAndPiecesAreNamed) {
  TransformTree tree;
  tree.add_static(transform("a", "b", Vec3::Zero()));
  tree.add_static(transform("b", "a", Vec3::Zero()));
  tree.add_static(transform("c", "d", Vec3::Zero()));
  tree.finish();
  EXPECT_THAT(tree.a_from_b("c", "a", 0).reason, HasSubstr("go round in a circle"));
  EXPECT_EQ(tree.a_from_b("map", "d", 0).reason, "/tf has no frame map");
  TransformTree pieces;
  pieces.add_static(transform("c", "d", Vec3::Zero()));
  pieces.add_static(transform("e", "f", Vec3::Zero()));
  pieces.finish();
  EXPECT_EQ(pieces.a_from_b("d", "f", 0).reason, "/tf does not connect d and f");
}

TEST(TransformTree, ADrawingShowsTheTree) {
  EXPECT_THAT(moving_hand().drawing(), ElementsAre("world", "  hand  11 poses, 10.0 Hz", "    camera  static"));
}

}  // namespace
}  // namespace vantage
