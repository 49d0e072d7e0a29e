#include "vantage/recordings/scan_folder.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/formats/conf_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names(const ScanSet& set) {
  std::vector<std::string> result;
  for (const ScanFile& scan : set.scans) result.push_back(scan.name);
  return result;
}

Pose pose_number(int i) { return look_at({1.0 + i, 2, 3}, {0, 0, 0}); }

RangeCamera small_camera() { return camera_from_intrinsics(40, 40, 19.5, 14.5, {40, 30}); }

/// Frames with these names, all the same plane at 1 m, with intrinsics but without poses.
void write_frames(const TestFolder& folder, const std::vector<std::string>& frame_names) {
  write_file_atomically(folder / "camera-intrinsics.txt", "40 0 19.5\n0 40 14.5\n0 0 1\n");
  for (const std::string& name : frame_names) {
    write_depth_png(folder / (name + ".depth.png"), {small_camera(), std::vector<float>(1200, 1.0F)});
  }
}

TEST(ScanFolder, DepthFramesComeInTheOrderOfTheirNumbersWithTheirPoses) {
  const TestFolder folder;
  write_frames(folder, {"frame-9", "frame-10"});
  write_pose(folder / "frame-9.pose.txt", pose_number(9));
  write_file_atomically(folder / "frame-10.pose.json", R"({"position": [1, 2, 3], "orientation": [0, 0, 0, 1]})");
  const ScanSet set = open_scans(folder.path(), {.depth_range = {0.25, 1.5}});
  EXPECT_THAT(names(set), ElementsAre("frame-9", "frame-10"));
  EXPECT_EQ(set.scans[0].view.world_from_sensor.matrix(), pose_number(9).matrix());
  EXPECT_EQ(set.scans[1].view.position(), Vec3(1, 2, 3));
  ASSERT_TRUE(set.camera.has_value());
  EXPECT_EQ(set.camera->resolution, (Resolution{40, 30}));
  EXPECT_EQ(set.camera->max_depth, 1.5);
  const auto scan = std::get<ImageScan>(set.scans[0].read());
  EXPECT_EQ(scan.image.at(20, 15), 1.0F);
  EXPECT_EQ(scan.image.camera.min_depth, 0.25);
  EXPECT_TRUE(scan.normals[15 * 40 + 20].isApprox(Vec3f(0, 0, -1), 1e-5F));
}

TEST(ScanFolder, TheFirstFrameIsDecodedOnceAlthoughItSaysHowLargeAllAre) {
  const TestFolder folder;
  write_frames(folder, {"a", "b"});
  for (const char* name : {"a.pose.txt", "b.pose.txt"}) write_pose(folder / name, pose_number(1));
  const ScanSet set = open_scans(folder.path());
  std::filesystem::remove(folder / "a.depth.png");
  EXPECT_EQ(std::get<ImageScan>(set.scans[0].read()).image.at(20, 15), 1.0F);
  EXPECT_THAT(input_error_of([&] { (void)set.scans[0].read(); }), HasSubstr("a.depth.png"))
      << "it is not kept any longer";
  EXPECT_EQ(std::get<ImageScan>(set.scans[1].read()).image.at(20, 15), 1.0F);
}

TEST(ScanFolder, PosesMayLieInAFolderOrATrajectory) {
  const TestFolder folder;
  write_frames(folder, {"a", "b"});
  std::filesystem::create_directory(folder / "robot");
  for (const int i : {0, 1}) write_pose(folder / "robot" / (i == 0 ? "a.pose.txt" : "b.pose.txt"), pose_number(i));
  const ScanSet from_folder = open_scans(folder.path(), {.poses = "robot"});
  EXPECT_EQ(from_folder.scans[1].view.world_from_sensor.matrix(), pose_number(1).matrix());
  write_trajectory(folder / "poses.tum", {{10, pose_number(4)}, {20, pose_number(5)}});
  const ScanSet by_order = open_scans(folder.path(), {.poses = "poses.tum"});
  EXPECT_TRUE(by_order.scans[1].view.world_from_sensor.isApprox(pose_number(5), 1e-12));
  const ScanSet absolute = open_scans(folder.path(), {.poses = (folder / "poses.tum").string()});
  EXPECT_TRUE(absolute.scans[0].view.world_from_sensor.isApprox(pose_number(4), 1e-12));
  write_trajectory(folder / "long.tum", {{10, pose_number(4)}, {20, pose_number(5)}, {30, pose_number(6)}});
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), {.poses = "long.tum"}); }),
              HasSubstr("long.tum: has 3 poses for 2 scans"));
}

TEST(ScanFolder, NamesThatAreTimesFindTheNearestPose) {
  const TestFolder folder;
  write_frames(folder, {"100.50", "100.93"});
  write_trajectory(folder / "poses.tum",
                   {{100.49, pose_number(0)}, {100.52, pose_number(1)}, {100.94, pose_number(2)}});
  const ScanSet set = open_scans(folder.path(), {.poses = "poses.tum"});
  EXPECT_TRUE(set.scans[0].view.world_from_sensor.isApprox(pose_number(0), 1e-12));
  EXPECT_TRUE(set.scans[1].view.world_from_sensor.isApprox(pose_number(2), 1e-12));
  write_trajectory(folder / "poses.tum", {{100.49, pose_number(0)}, {100.99, pose_number(1)}});
  const ScanSet rest = open_scans(folder.path(), {.poses = "poses.tum", .match = PoseMatch::time});
  EXPECT_THAT(names(rest), ElementsAre("100.50"));
  EXPECT_THAT(rest.left_out, ElementsAre("scan '100.93' has no pose within 0.02 s"));
}

TEST(ScanFolder, NumberedFramesGoWithTheTimesOfATrajectoryInTheirOrder) {
  const TestFolder folder;
  write_frames(folder, {"000000", "000001"});
  write_trajectory(folder / "poses.tum", {{1305031102.17, pose_number(4)}, {1305031102.21, pose_number(5)}});
  const ScanSet set = open_scans(folder.path(), {.poses = "poses.tum"});
  ASSERT_EQ(set.scans.size(), 2U);
  EXPECT_TRUE(set.scans[1].view.world_from_sensor.isApprox(pose_number(5), 1e-12));
  EXPECT_THAT(
      input_error_of([&] { (void)open_scans(folder.path(), {.poses = "poses.tum", .match = PoseMatch::time}); }),
      HasSubstr("none of the 2 scans has a pose within 20 ms"));
}

TEST(ScanFolder, FramesWithoutAPoseAreLeftOutAndNamed) {
  const TestFolder folder;
  write_frames(folder, {"a", "b", "c"});
  write_pose(folder / "a.pose.txt", pose_number(0));
  write_file_atomically(folder / "b.pose.txt",
                        "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n0 0 0 1\n");
  const ScanSet set = open_scans(folder.path());
  EXPECT_THAT(names(set), ElementsAre("a"));
  EXPECT_THAT(set.left_out,
              ElementsAre("scan 'b' has a pose that is not finite: tracking was lost", "scan 'c' has no pose"));
}

TEST(ScanFolder, NamesThatAreNoUtf8AreSpelled) {
  const TestFolder folder;
  write_frames(folder, {"caf\xe9"});
  write_pose(folder / "caf\xe9.pose.txt", pose_number(0));
  const ScanSet set = open_scans(folder.path());
  EXPECT_THAT(names(set), ElementsAre("caf\\xe9"));
  EXPECT_EQ(std::get<ImageScan>(set.scans[0].read()).image.at(20, 15), 1.0F);
}

TEST(ScanFolder, AConfGoesOnWithoutScansThatDoNotLieBesideIt) {
  const TestFolder folder;
  write_file_atomically(folder / "a.conf", "mesh thing_cyl 0 0 0 0 0 0 1\nbmesh b.ply 0 0 0 0 0 0 1\n");
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder / "a.conf"); }),
              HasSubstr("a.conf: none of the 2 scans that it names lies beside it; scan 'thing_cyl' does not"));
  write_file_atomically(folder / "b.ply", "");
  const ScanSet set = open_scans(folder / "a.conf");
  EXPECT_THAT(names(set), ElementsAre("b"));
  EXPECT_THAT(set.left_out, ElementsAre("scan 'thing_cyl' does not lie beside a.conf"));
}

TEST(ScanFolder, RawFloatsTakeTheirSizeFromTheIntrinsics) {
  const TestFolder folder;
  const float depth = 1.25F;
  std::string bytes;
  for (int i = 0; i < 12; ++i) bytes.append(reinterpret_cast<const char*>(&depth), 4);
  write_file_atomically(folder / "a.depth.raw", bytes);
  write_pose(folder / "a.pose.txt", pose_number(0));
  write_file_atomically(folder / "camera-intrinsics.txt", "40 0 1.5\n0 40 1\n0 0 1\n");
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path()); }),
              HasSubstr("a.depth.raw: the size of a raw image is not known"));
  write_file_atomically(folder / "camera.json",
                        R"({"width": 4, "height": 3, "intrinsic_matrix": [40, 0, 0, 0, 40, 0, 1.5, 1, 1]})");
  const ScanSet set = open_scans(folder.path(), {.intrinsics = "camera.json"});
  EXPECT_EQ(std::get<ImageScan>(set.scans[0].read()).image.depth, std::vector<float>(12, 1.25F));
}

TEST(ScanFolder, CloudsAreSeenFromTheOriginOfTheirSensor) {
  const TestFolder folder;
  write_file_atomically(folder / "a.xyz", "0 0 1\n0.1 0 1\n");
  write_pose(folder / "a.pose.txt", pose_number(1));
  write_file_atomically(
      folder / "b.pcd",
      "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nWIDTH 1\nHEIGHT 1\n"
      "VIEWPOINT 5 0 0 1 0 0 0\nDATA ascii\n5 0 2 0 0 1\n");
  write_pose(folder / "b.pose.txt", pose_number(2));
  const ScanSet set = open_scans(folder.path());
  EXPECT_THAT(names(set), ElementsAre("a", "b"));
  EXPECT_FALSE(set.camera.has_value());
  const auto a = std::get<PointScan>(set.scans[0].read());
  EXPECT_EQ(a.points, (std::vector<Vec3>{{0, 0, 1}, {0.1, 0, 1}}));
  EXPECT_EQ(a.origins, (std::vector<Vec3>{{0, 0, 0}}));
  EXPECT_TRUE(a.normals.empty());
  const auto b = std::get<PointScan>(set.scans[1].read());
  EXPECT_EQ(b.points, (std::vector<Vec3>{{0, 0, 2}}));
  EXPECT_TRUE(b.normals[0].isApprox(Vec3f(0, 0, -1))) << "turned towards the sensor";
  EXPECT_TRUE(set.scans[1].view.position().isApprox(pose_number(2) * Vec3(5, 0, 0)));
}

TEST(ScanFolder, WhatIsMissingIsNamed) {
  const TestFolder folder;
  const auto error = [&](const ScanFolderOptions& options = {}) {
    return input_error_of([&] { (void)open_scans(folder.path(), options); });
  };
  EXPECT_THAT(error(), HasSubstr("has no scans; must have NAME.depth.png, .exr, .tif, .npy, .pfm or .raw, NAME.ply, "
                                 ".pcd or .xyz, a .conf file"));
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder / "none"); }),
              HasSubstr("none: there is no such file or folder"));
  write_frames(folder, {"a"});
  EXPECT_THAT(error(), HasSubstr("scan 'a' has no pose; must have a.pose.txt or a.pose.json"));
  std::filesystem::create_directory(folder / "pose_robot");
  write_pose(folder / "pose_robot" / "a.pose.txt", pose_number(0));
  EXPECT_THAT(error(), HasSubstr("a.pose.json; choose one of the folders with --poses: pose_robot"));
  EXPECT_THAT(error({.poses = "nowhere"}), HasSubstr("poses = 'nowhere': there is no such folder or file"));
  EXPECT_THAT(error({.poses = "pose_robot", .intrinsics = "none.txt"}), HasSubstr("none.txt: cannot be read"));
  std::filesystem::remove(folder / "camera-intrinsics.txt");
  EXPECT_THAT(error(), HasSubstr("has no intrinsics; must have one of camera-intrinsics.txt, "));
  write_file_atomically(folder / "camera-intrinsics.txt", "40 0 119.5\n0 40 14.5\n0 0 1\n");
  EXPECT_THAT(
      error({.poses = "pose_robot"}),
      HasSubstr("camera-intrinsics.txt with a.depth.png: intrinsics: principal point (119.5, 14.5) lies outside"));
  write_file_atomically(folder / "a.depth.raw", "");
  EXPECT_THAT(error({.poses = "pose_robot"}), HasSubstr("a scan must be one file"));
  EXPECT_THAT(error({.depth_scale = -1}), HasSubstr("depth scale = -1"));
  EXPECT_THAT(error({.depth_range = {2, 1}}), HasSubstr("depth range = 2,1 m: must be NEAR,FAR with 0 <= NEAR < FAR"));
  EXPECT_THAT(error({.no_return = 70000}), HasSubstr("no-return = 70000: must be within 1 and 65535"));
}

TEST(ScanFolder, AnImageOfAnotherSizeIsAnErrorWhenItIsRead) {
  const TestFolder folder;
  write_frames(folder, {"a"});
  write_depth_png(folder / "b.depth.png", {camera_from_apertures(1, 1, {20, 30}), std::vector<float>(600, 1.0F)});
  for (const char* name : {"a", "b"}) write_pose(folder / (std::string(name) + ".pose.txt"), pose_number(0));
  const ScanSet set = open_scans(folder.path());
  EXPECT_THAT(input_error_of([&] { (void)set.scans[1].read(); }),
              HasSubstr("b.depth.png: has 20x30 pixels, the camera 40x30"));
}

TEST(Conf, LinesAreReadAndBadOnesRefused) {
  const std::string half = "0.70710678118654752";
  const auto scans = parse_conf(
      "camera 1 2 3 0 0 0 1\nbmesh a.ply 1 2 3 0 0 " + half + " " + half + "\nmesh b.ply 0 0 0 0 0 0 1\n", "a.conf");
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0].file, "a.ply");
  EXPECT_TRUE((scans[0].world_from_scan * Vec3(1, 0, 0)).isApprox(Vec3(1, 1, 3)))
      << "the transposed rotation: x goes to -y";
  const auto error = [](const std::string& text) { return input_error_of([&] { (void)parse_conf(text, "a.conf"); }); };
  EXPECT_THAT(error(""), HasSubstr("a.conf: has no line 'bmesh FILE tx ty tz qx qy qz qw'"));
  EXPECT_EQ(error("bmesh\n"), "a.conf, line 1: the name of the scan's file is missing");
  EXPECT_EQ(error("bmesh a.ply 1 2 3 0 0 0\n"), "a.conf, line 1: qw is missing");
  EXPECT_EQ(error("bmesh a.ply 1 2 x 0 0 0 1\n"), "a.conf, line 1: tz = 'x': must be a number");
  EXPECT_EQ(error("bmesh a.ply 0 0 0 0 0 0 0\n"), "a.conf: a.ply: the quaternion has length 0, must be 1");
  EXPECT_THAT(error("bmesh ../a.ply 0 0 0 0 0 0 1\n"),
              HasSubstr("'../a.ply': must be the name of a file beside this one"));
  const FuzzCount count = read_damaged("camera 1 2 3 0 0 0 1\nbmesh a.ply 1 2 3 0 0 0 1\n", 1000,
                                       [](const std::string& text) { ASSERT_FALSE(parse_conf(text, "a").empty()); });
  EXPECT_EQ(count.accepted + count.refused, 1000);
  EXPECT_GT(count.refused, 300);
}

TEST(NaturalOrder, ComparesNumbersByValue) {
  EXPECT_TRUE(comes_before("frame-9", "frame-10"));
  EXPECT_FALSE(comes_before("frame-10", "frame-9"));
  EXPECT_TRUE(comes_before("a", "b"));
  EXPECT_TRUE(comes_before("a", "a1"));
  EXPECT_TRUE(comes_before("1.5", "1.10")) << "the parts before and after a dot are numbers of their own";
  EXPECT_TRUE(comes_before("a01", "a1"));
  EXPECT_FALSE(comes_before("a1", "a01"));
  EXPECT_FALSE(comes_before("a1", "a1"));
  EXPECT_TRUE(comes_before("99999999999999999999998", "99999999999999999999999"));
}

std::filesystem::path shared(const char* set) { return std::filesystem::path(VANTAGE_SHARED_DATA) / "scans" / set; }

TEST(ScanFolder, TheRealFramesOfTheTrayAreRead) {
  if (!std::filesystem::exists(shared("ur5_tray"))) GTEST_SKIP() << shared("ur5_tray") << " does not exist";
  const ScanSet set = open_scans(shared("ur5_tray"), {.depth_range = {0.25, 1.5}});
  ASSERT_EQ(set.scans.size(), 24U);
  EXPECT_EQ(set.scans[0].name, "frame-000150");
  // The table is at z = 0.01 to 0.02 in the base frame: poses, scale and intrinsics put many points there.
  const PointCloud cloud = points_of(set.scans[0].read());
  int on_table = 0;
  for (const Vec3& point : cloud.points) {
    const double height = (set.scans[0].view.world_from_sensor * point).z();
    on_table += height > 0 && height < 0.04 ? 1 : 0;
  }
  EXPECT_GT(on_table, static_cast<int>(cloud.size()) / 3);
}

TEST(ScanFolder, TheShelfNeedsAChoiceOfPoses) {
  if (!std::filesystem::exists(shared("apc_shelf"))) GTEST_SKIP() << shared("apc_shelf") << " does not exist";
  EXPECT_THAT(input_error_of([&] { (void)open_scans(shared("apc_shelf")); }),
              HasSubstr("choose one of the folders with --poses: pose_calibrated, pose_robot"));
  const ScanSet set = open_scans(shared("apc_shelf"), {.depth_scale = 0.0001, .poses = "pose_robot"});
  EXPECT_EQ(set.scans.size(), 15U);
}

TEST(ScanFolder, TheStanfordBunnyFitsItsMesh) {
  if (!std::filesystem::exists(shared("stanford_bunny"))) GTEST_SKIP() << shared("stanford_bunny") << " does not exist";
  const ScanSet set = open_scans(shared("stanford_bunny"));
  ASSERT_EQ(set.scans.size(), 10U);
  EXPECT_EQ(open_scans(shared("stanford_bunny") / "bun.conf").scans.size(), 10U);
  const TriangleMesh mesh = read_mesh(shared("stanford_bunny") / "bun_zipper.ply");
  for (const std::size_t s : {std::size_t{1}, std::size_t{5}}) {  // bun045, top2: rotations about different axes
    const auto scan = std::get<PointScan>(set.scans[s].read());
    const Pose& world_from_scan = set.scans[s].view.world_from_sensor;
    ASSERT_EQ(scan.normals.size(), scan.points.size());
    ASSERT_EQ(scan.origins.size(), scan.points.size());
    std::vector<double> distances;
    int with_normal = 0, facing = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vec3 normal = scan.normals[i].cast<double>();
      with_normal += normal.isZero(0) ? 0 : 1;
      facing += normal.dot(scan.points[i] - scan.origins[i]) < 0 ? 1 : 0;
      EXPECT_EQ(scan.origins[i], Vec3(scan.points[i].x(), 0.18, 1.3));
      if (i % 500 != 0) continue;
      double nearest = 1;
      for (const Vec3& vertex : mesh.vertices)
        nearest = std::min(nearest, (world_from_scan * scan.points[i] - vertex).norm());
      distances.push_back(nearest);
    }
    EXPECT_GT(with_normal, static_cast<int>(0.97 * static_cast<double>(scan.points.size())));
    EXPECT_EQ(facing, with_normal);
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                     distances.end());
    EXPECT_GT(distances.size(), 50U);
    // The mesh's vertices are about a millimetre apart; with R instead of its transpose the median is over a
    // centimetre.
    EXPECT_LT(distances[distances.size() / 2], 0.001) << set.scans[s].name;
  }
}

}  // namespace
}  // namespace vantage
