#include "vantage/recordings/bag_frames.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"

// The bags in tests/recordings/fixtures were written by other implementations from the frames that small_depth() and
// small_pose() compute here a second time (see README.md there).

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::filesystem::path bags = VANTAGE_BAGS;

std::uint16_t small_depth(int frame, int column, int row) {
  if (column == 5 && row == 0) return 65535;
  return static_cast<std::uint16_t>((column + row) % 7 == 0 ? 0 : 500 + 10 * column + 3 * row + frame * 17);
}

Pose small_pose(double frame) {
  Pose pose = Pose::Identity();
  pose.translation() = Vec3(0.1 * frame, 0.5 - 0.05 * frame, 0.3);
  pose.linear() = Eigen::AngleAxisd(0.2 * frame, Vec3::UnitZ()).toRotationMatrix();
  return pose;
}

const Gray16& gray(const Frame& frame) { return std::get<Gray16>(std::get<DepthPixels>(frame.measured)); }

double pose_distance(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff(); }

/// Reads all frames and compares them with those that were written; the number of them.
int matching_frames(const std::filesystem::path& path, const BagOptions& options) {
  const auto source = open_bag_frames(path, options);
  int frames = 0;
  for (auto frame = source->next(); frame; frame = source->next(), ++frames) {
    const Gray16& image = gray(*frame);
    EXPECT_EQ(image.resolution, (Resolution{16, 12}));
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 16; ++column)
        EXPECT_EQ(image.values.at(static_cast<std::size_t>(16 * row + column)), small_depth(frames, column, row));
    }
    EXPECT_LT(pose_distance(frame->info.world_from_sensor.value(), small_pose(frames)), 1e-12);
    EXPECT_NEAR(frame->info.time_s.value(), 1.7e9 + 0.1 * frames, 1e-6);
    const Intrinsics& k = frame->intrinsics.value();
    EXPECT_EQ((std::array{k.fx, k.fy, k.cx, k.cy}), (std::array{20.0, 21.0, 7.5, 5.5}));
  }
  return frames;
}

TEST(BagFrames, EveryContainerAndCompressionGivesTheFramesThatWereWritten) {
  const BagOptions depth{.topic = "/camera/depth/image_raw"};
  for (const char* file : {"none.mcap", "lz4.mcap", "zstd.mcap", "flat.mcap", "big_endian.mcap", "small.db3", "split",
                           "packed", "packed/bag_0.db3.zstd", "none.bag", "bz2.bag", "lz4.bag"}) {
    SCOPED_TRACE(file);
    EXPECT_EQ(matching_frames(bags / file, depth), 6);
    EXPECT_THAT(open_bag_frames(bags / file, depth)->left_out(), IsEmpty());
  }
}

TEST(BagFrames, OneLineSaysWhatWasRecognised) {
  EXPECT_EQ(open_bag_frames(bags / "lz4.bag")->description(),
            "ROS 1 bag (lz4): 6 depth images of /camera/depth/image_raw (16x12 16UC1), poses from /tf "
            "(camera_optical_frame in base), intrinsics from /camera/depth/camera_info");
  EXPECT_THAT(open_bag_frames(bags / "packed", {.topic = "/cloud"})->description(),
              HasSubstr("ROS 2 sqlite3 (zstd messages), packed with zstd: 6 clouds of /cloud (16x12 points)"));
}

TEST(BagFrames, PackedDepthImagesHoldTheSameNumbers) {
  for (const char* topic : {"/camera/depth/image_raw/compressedDepth", "/camera/rvl/image_raw/compressedDepth"}) {
    SCOPED_TRACE(topic);
    EXPECT_EQ(matching_frames(bags / "zstd.mcap", {.topic = topic}), 6);
  }
}

TEST(BagFrames, FloatingPointDepthsAreMetresInEitherByteOrder) {
  for (const char* file : {"none.mcap", "big_endian.mcap"}) {
    const auto source = open_bag_frames(bags / file, {.topic = "/camera/depth_float/image_raw"});
    const Frame frame = source->read(3);
    const auto& image = std::get<FloatImage>(std::get<DepthPixels>(frame.measured));
    for (int column = 0; column < 16; ++column)
      EXPECT_EQ(image.values.at(static_cast<std::size_t>(16 + column)),
                static_cast<float>(small_depth(3, column, 1) / 1000.0));
  }
}

TEST(BagFrames, CloudsHaveTheirPointsInRows) {
  const auto source = open_bag_frames(bags / "small.db3", {.topic = "/cloud"});
  const Frame frame = source->read(2);
  const auto& cloud = std::get<CloudFile>(frame.measured);
  EXPECT_EQ(cloud.grid, (Resolution{16, 12}));
  int points = 0;
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 16; ++column) {
      const int depth = small_depth(2, column, row);
      const std::int32_t point = cloud.point_of_cell.at(static_cast<std::size_t>(16 * row + column));
      if (depth == 0 || depth == 65535) {
        EXPECT_EQ(point, -1);
        continue;
      }
      const double z = depth / 1000.0;
      const Vec3 expected((column - 7.5) / 20 * z, (row - 5.5) / 21 * z, z);
      EXPECT_LT((cloud.cloud.points.at(static_cast<std::size_t>(point)) - expected).norm(), 1e-7);
      ++points;
    }
  }
  EXPECT_EQ(cloud.cloud.size(), static_cast<std::size_t>(points));
}

TEST(BagFrames, PosesComeFromTopicsToo) {
  for (const char* topic : {"/pose", "/odom"}) {
    const auto source = open_bag_frames(bags / "none.mcap", {.topic = "/camera/depth/image_raw", .poses = topic});
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_LT(pose_distance(source->frames()[i].world_from_sensor.value(), small_pose(static_cast<double>(i))), 1e-12)
          << topic;
  }
  EXPECT_THAT(open_bag_frames(bags / "none.mcap", {.topic = "/cloud", .poses = "/odom"})->description(),
              HasSubstr("poses from /odom (in base of hand, on to camera_optical_frame by /tf)"));
}

TEST(BagFrames, PosesComeFromATrajectoryByTime) {
  const TestFolder folder;
  // Lines between the frames, which are 0.1 s apart from 0 on; none near the last one.
  write_file_atomically(folder / "poses.txt",
                        "-0.05 -0.05 0.525 0.3 0 0 0 1\n0.05 0.05 0.475 0.3 0 0 0 1\n0.15 0.15 0.425 0.3 0 0 0 1\n"
                        "0.25 0.25 0.375 0.3 0 0 0 1\n0.35 0.35 0.325 0.3 0 0 0 1\n0.41 0.41 0.295 0.3 0 0 0 1\n");
  const auto source = open_bag_frames(bags / "realsense.bag", {.poses = folder / "poses.txt"});
  ASSERT_EQ(source->frames().size(), 5U);
  for (int i = 0; i < 5; ++i) {
    const Pose pose = source->frames()[static_cast<std::size_t>(i)].world_from_sensor.value();
    EXPECT_LT((pose.translation() - small_pose(i).translation()).norm(), 1e-12);
  }
  EXPECT_THAT(source->left_out(), ElementsAre("frame-000005: has no pose: the last pose is 0.090 s earlier"));
}

TEST(BagFrames, TheWorldMayBeAnyFrameOfTheTree) {
  const auto source = open_bag_frames(bags / "zstd.mcap", {.topic = "/camera/depth/image_raw", .frame = "hand"});
  const Pose first = source->frames()[0].world_from_sensor.value();
  EXPECT_LT(pose_distance(first, source->frames()[5].world_from_sensor.value()), 1e-12);
  EXPECT_NEAR(first.translation().z(), 0.05, 1e-9);
  EXPECT_EQ(input_error_of([] { (void)open_bag_frames(bags / "none.bag", {.frame = "map"}); }),
            "frame = 'map': " + (bags / "none.bag").string() + " has no such frame; see `vantage recording info`");
}

TEST(BagFrames, EveryNthFrameKeepsItsNumber) {
  const auto source = open_bag_frames(bags / "none.bag", {.every = 4});
  ASSERT_EQ(source->frames().size(), 2U);
  EXPECT_EQ(source->frames()[1].name, "frame-000004");
  EXPECT_EQ(gray(source->read(1)).values.at(1), small_depth(4, 1, 0));
}

TEST(BagFrames, RealSenseRecordingsHaveTheirUnitAndNoPoses) {
  const auto source = open_bag_frames(bags / "realsense.bag");
  ASSERT_EQ(source->frames().size(), 6U);
  const Frame frame = source->read(5);
  EXPECT_FALSE(frame.info.world_from_sensor.has_value());
  EXPECT_NEAR(frame.metres_per_unit.value(), 0.00025, 1e-9);
  EXPECT_EQ(frame.intrinsics.value().fx, 20);
  EXPECT_EQ(gray(frame).values.at(2), small_depth(5, 2, 0));
}

TEST(BagFrames, SeveralTopicsWithDepthAreNamed) {
  EXPECT_THAT(input_error_of([] { (void)open_bag_frames(bags / "none.mcap"); }),
              HasSubstr("has several topics with depth; choose one with --topic: /camera/depth/image_raw, "
                        "/camera/depth_float/image_raw, /camera/rvl/image_raw/compressedDepth"));
  EXPECT_THAT(input_error_of([] { (void)open_bag_frames(bags / "none.bag", {.topic = "/depth"}); }),
              HasSubstr("topic = '/depth'"));
}

}  // namespace
}  // namespace vantage
