#include "vantage/recordings/folder_layout.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int frames = 4;
const std::string matrix = "40 0 19.5\n0 41 14.5\n0 0 1\n";

Pose pose_number(int i) { return look_at({1.0 + 0.3 * i, 2.0 - 0.2 * i, 3}, {0, 0.1, 0}); }

Gray16 image_number(int i) {
  Gray16 image{{40, 30}, std::vector<std::uint16_t>(1200)};
  for (std::size_t p = 0; p < image.values.size(); ++p)
    image.values[p] = static_cast<std::uint16_t>(p % 7 == 0 ? 0 : 1000 + 100 * static_cast<std::size_t>(i) + p % 50);
  return image;
}

std::string rows(const Eigen::Matrix4d& m, int count, const char* between_rows) {
  std::string text;
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < 4; ++column) text += fmt::format("{}{}", column == 0 ? "" : " ", m(row, column));
    text += row + 1 < count ? between_rows : "\n";
  }
  return text;
}

std::string tum_line(double time, const Pose& pose) {
  const Eigen::Quaterniond q(Mat3(pose.linear()));
  const Vec3 t = pose.translation();
  return fmt::format("{:.6f} {} {} {} {} {} {} {}\n", time, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

std::string list_of(const Eigen::Matrix4d& m, bool by_columns) {
  std::string text = "[";
  for (int i = 0; i < 16; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ", ", by_columns ? m(i % 4, i / 4) : m(i / 4, i % 4));
  return text + "]";
}

/// A folder with depth/NAME.png for each of the frames.
class Layout : public testing::Test {
 protected:
  void write_images(const std::string& pattern, double step = 1) {
    for (int i = 0; i < frames; ++i) {
      const std::filesystem::path path = folder / fmt::format(fmt::runtime(pattern), static_cast<int>(step * i));
      std::filesystem::create_directories(path.parent_path());
      write_file_atomically(path, encode_png16(image_number(i)));
    }
  }

  /// The set must have the frames as they are, at their poses.
  void expect_frames(const ScanFolderOptions& options = {}, double metres_per_unit = 0.001) {
    set = open_scans(folder.path(), options);
    ASSERT_EQ(set.scans.size(), static_cast<std::size_t>(frames));
    for (int i = 0; i < frames; ++i) {
      const ScanFile& scan = set.scans[static_cast<std::size_t>(i)];
      EXPECT_TRUE(scan.view.world_from_sensor.isApprox(pose_number(i), 1e-12)) << i;
      const RangeImage image = std::get<ImageScan>(scan.read()).image;
      const Gray16 expected = image_number(i);
      for (std::size_t p = 0; p < expected.values.size(); ++p)
        ASSERT_EQ(image.depth[p], static_cast<float>(metres_per_unit * expected.values[p])) << p;
      EXPECT_NEAR(image.camera.rays().x(0), -19.5 / 40, 1e-12);
      EXPECT_NEAR(image.camera.rays().y(0), -14.5 / 41, 1e-12);
    }
    ASSERT_TRUE(set.camera.has_value());
  }

  TestFolder folder;
  ScanSet set;
};

TEST_F(Layout, TumRgbdGoesByTime) {
  std::string list = "# depth maps\n", poses = "# ground truth\n";
  for (int i = 0; i < frames; ++i) {
    write_images("depth/{}.png");
    list += fmt::format("{:.6f} depth/{}.png\n", 1305031102.16 + 0.04 * i, i);
    poses += tum_line(1305031102.155 + 0.04 * i, pose_number(i)) + tum_line(1305031102.175 + 0.04 * i, pose_number(9));
  }
  list += "1305031109.000000 depth/0.png\n1305031109.100000 depth/gone.png\n";
  write_file_atomically(folder / "depth.txt", list);
  write_file_atomically(folder / "groundtruth.txt", poses);
  write_file_atomically(folder / "camera-intrinsics.txt", matrix);
  expect_frames({}, 1.0 / 5000);
  EXPECT_EQ(set.description, "TUM RGB-D: 4 depth images, TUM trajectory groundtruth.txt, 4 matched within 20 ms");
  EXPECT_THAT(set.left_out,
              ElementsAre(StartsWith("frame 'gone' has no file "), "frame '0' has no pose within 0.02 s"));
  EXPECT_EQ(std::get<ImageScan>(open_scans(folder.path(), {.depth_scale = 0.001}).scans[0].read()).image.depth[1],
            1.001F)
      << "the option counts for more than the layout";
}

TEST_F(Layout, BopIsInMillimetresAndTheWorldMayBeAnObject) {
  write_images("depth/{:06}.png", 3);
  std::string cameras, truth;
  for (int i = 0; i < frames; ++i) {
    const Pose model_from_camera = pose_number(i);
    const Eigen::Matrix4d m = model_from_camera.inverse().matrix();
    const std::string rotation = fmt::format("[{}, {}, {}, {}, {}, {}, {}, {}, {}]", m(0, 0), m(0, 1), m(0, 2), m(1, 0),
                                             m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2));
    const std::string translation = fmt::format("[{}, {}, {}]", 1000 * m(0, 3), 1000 * m(1, 3), 1000 * m(2, 3));
    cameras += fmt::format(R"({}"{}": {{"cam_K": [40, 0, 19.5, 0, 41, 14.5, 0, 0, 1], "depth_scale": 0.5}})",
                           i == 0 ? "{" : ", ", 3 * i);
    truth += fmt::format(R"({}"{}": [{{"cam_R_m2c": {}, "cam_t_m2c": {}, "obj_id": 7}}])", i == 0 ? "{" : ", ", 3 * i,
                         rotation, translation);
  }
  write_file_atomically(folder / "scene_camera.json", cameras + "}");
  write_file_atomically(folder / "scene_gt.json", truth + "}");
  expect_frames({}, 0.0005);
  EXPECT_EQ(set.description, "BOP: 4 depth images, poses of scene_gt.json in the frame of object 7");
  EXPECT_EQ(set.scans[1].name, "000003");
}

TEST_F(Layout, Open3dWritesLogsTrajectoriesAndPoseGraphs) {
  write_images("depth/{:06}.png");
  write_file_atomically(folder / "intrinsic.json",
                        R"({"width": 40, "height": 30, "intrinsic_matrix": [40, 0, 0, 0, 41, 0, 19.5, 14.5, 1]})");
  std::string log, trajectory = R"({"class_name": "PinholeCameraTrajectory", "parameters": [)",
                   graph = R"({"class_name": "PoseGraph", "edges": [], "nodes": [)";
  for (int i = 0; i < frames; ++i) {
    const Pose pose = pose_number(i);
    log += fmt::format("{} {} {}\n{}", i, i, i + 1, rows(pose.matrix(), 4, "\n"));
    trajectory += fmt::format(R"({}{{"extrinsic": {}}})", i == 0 ? "" : ", ", list_of(pose.inverse().matrix(), true));
    graph += fmt::format(R"({}{{"pose": {}}})", i == 0 ? "" : ", ", list_of(pose.matrix(), true));
  }
  write_file_atomically(folder / "trajectory.log", log);
  expect_frames();
  EXPECT_EQ(set.description, "Open3D: 4 depth images, Open3D log trajectory.log, 4 matched in their order");
  std::filesystem::remove(folder / "trajectory.log");
  write_file_atomically(folder / "camera_trajectory.json", trajectory + "]}");
  expect_frames();
  std::filesystem::remove(folder / "camera_trajectory.json");
  write_file_atomically(folder / "pose_graph.json", graph + "]}");
  expect_frames();
  EXPECT_THAT(set.description, HasSubstr("Open3D pose graph pose_graph.json"));
}

TEST_F(Layout, TransformsJsonHasOpenGlAxes) {
  write_images("depth/frame_{:05}.png");
  std::string entries;
  for (int i = 0; i < frames; ++i) {
    Eigen::Matrix4d gl = pose_number(i).matrix();
    gl.col(1) *= -1;
    gl.col(2) *= -1;
    std::string list;
    for (int row = 0; row < 4; ++row)
      list += fmt::format("{}[{}, {}, {}, {}]", row == 0 ? "" : ", ", gl(row, 0), gl(row, 1), gl(row, 2), gl(row, 3));
    entries += fmt::format(R"({{"file_path": "images/frame_{:05}.png", "transform_matrix": [{}]}}, )", i, list);
  }
  entries +=
      R"({"file_path": "images/frame_00099.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})";
  write_file_atomically(
      folder / "transforms.json",
      R"({"fl_x": 40, "fl_y": 41, "cx": 19.5, "cy": 14.5, "w": 40, "h": 30, "frames": [)" + entries + "]}");
  expect_frames();
  EXPECT_EQ(set.description, "NeRF transforms.json: 4 depth images, OpenGL axes turned");
  EXPECT_THAT(set.left_out, ElementsAre(StartsWith("frame 4 has no depth image")));
}

TEST_F(Layout, ColmapGivesCameraFromWorld) {
  write_images("depth/frame_{:05}.png");
  std::string images = "# Image list\n";
  for (int i = 0; i < frames; ++i) {
    const Pose camera_from_world = pose_number(i).inverse();
    const Eigen::Quaterniond q(Mat3(camera_from_world.linear()));
    const Vec3 t = camera_from_world.translation();
    images += fmt::format("{} {} {} {} {} {} {} {} 1 frame_{:05}.jpg\n{}\n", i + 1, q.w(), q.x(), q.y(), q.z(), t.x(),
                          t.y(), t.z(), i, i == 1 ? "" : "1.5 2.5 -1");
  }
  std::filesystem::create_directories(folder / "sparse" / "0");
  write_file_atomically(folder / "sparse" / "0" / "images.txt", images);
  write_file_atomically(folder / "sparse" / "0" / "cameras.txt", "1 PINHOLE 40 30 40 41 20 15\n");
  expect_frames();
  EXPECT_EQ(set.description, "COLMAP: 4 depth images, poses of images.txt");
}

TEST_F(Layout, ScanNetLosesTrackWithInfinitePoses) {
  write_images("depth/{}.png");
  std::filesystem::create_directories(folder / "pose");
  std::filesystem::create_directories(folder / "intrinsic");
  for (int i = 0; i < frames; ++i)
    write_file_atomically(folder / fmt::format("pose/{}.txt", i), rows(pose_number(i).matrix(), 4, "\n"));
  write_file_atomically(folder / "depth" / "9.png", encode_png16(image_number(9)));
  write_file_atomically(folder / "pose" / "9.txt",
                        "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n");
  write_file_atomically(folder / "depth" / "10.png", encode_png16(image_number(9)));
  write_file_atomically(folder / "intrinsic" / "intrinsic_depth.txt", "40 0 19.5 0\n0 41 14.5 0\n0 0 1 0\n0 0 0 1\n");
  expect_frames();
  EXPECT_THAT(set.description, StartsWith("ScanNet: 4 depth images, poses in pose, "));
  EXPECT_THAT(set.left_out,
              ElementsAre("frame '9' has a pose that is not finite: tracking was lost", "frame '10' has no pose"));
}

TEST_F(Layout, NumberedFilesOfAnyNameGoWithNumberedPoses) {
  write_images("depth{:06}.png");
  for (int i = 0; i < frames; ++i)
    write_file_atomically(folder / fmt::format("pose{:06}.txt", i), rows(pose_number(i).matrix(), 4, "\n"));
  write_file_atomically(folder / "camera-intrinsics.txt", matrix);
  expect_frames();
  EXPECT_EQ(set.scans[2].name, "000002");
  EXPECT_THAT(set.description, StartsWith("numbered frames: 4 depth images, poses in "));
}

TEST_F(Layout, PatternsChooseTheImagesAndListsThePoses) {
  write_images("cam0/range/img-{}.png");
  std::string kitti, flat;
  for (int i = 0; i < frames; ++i) {
    kitti += rows(pose_number(i).matrix(), 3, " ");
    flat += rows(pose_number(i).matrix(), 4, " ");
  }
  write_file_atomically(folder / "camera-intrinsics.txt", matrix);
  write_file_atomically(folder / "poses.txt", kitti);
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path()); }),
              HasSubstr("depth images of other names are given with --depth"));
  expect_frames({.depth = "cam?/range/*.png"});
  EXPECT_THAT(set.description, HasSubstr("KITTI trajectory poses.txt, 4 matched in their order"));
  write_file_atomically(folder / "poses.txt", flat);
  expect_frames({.depth = "*/*/img-*"});
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), {.depth = "none/*.png"}); }),
              HasSubstr("depth = 'none/*.png': no file in"));
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), {.depth = "*.txt"}); }),
              HasSubstr("is no depth image"));
}

TEST_F(Layout, MasksAndConfidencesTakePixelsAway) {
  write_images("depth/{}.png");
  std::filesystem::create_directories(folder / "confidence");
  std::filesystem::create_directories(folder / "masks");
  std::string poses;
  for (int i = 0; i < frames; ++i) {
    poses += rows(pose_number(i).matrix(), 3, " ");
    Gray16 confidence{{40, 30}, std::vector<std::uint16_t>(1200, 1)}, mask = confidence;
    confidence.values[1] = 2;
    confidence.values[2] = 3;
    mask.values[2] = 0;
    write_file_atomically(folder / fmt::format("confidence/{}.png", i), encode_png16(confidence));
    write_file_atomically(folder / fmt::format("masks/{}.png", i), encode_png16(mask));
  }
  write_file_atomically(folder / "poses.txt", poses);
  write_file_atomically(folder / "camera-intrinsics.txt", matrix);
  const auto depths = [&](const ScanFolderOptions& options) {
    const std::vector<float> all = std::get<ImageScan>(open_scans(folder.path(), options).scans[0].read()).image.depth;
    return std::vector<float>{all[1], all[2], all[3]};
  };
  EXPECT_THAT(depths({.confidence = "confidence,2"}), ElementsAre(1.001F, 1.002F, 0));
  EXPECT_THAT(depths({.masks = "masks", .confidence = "confidence,2"}), ElementsAre(1.001F, 0, 0));
  EXPECT_THAT(depths({.masks = "masks"}), ElementsAre(1.001F, 0, 1.003F));
  EXPECT_THAT(input_error_of([&] { (void)depths({.confidence = "confidence"}); }),
              HasSubstr("confidence = 'confidence': must be FOLDER,LEAST"));
  EXPECT_THAT(input_error_of([&] { (void)depths({.confidence = "nowhere,1"}); }),
              HasSubstr("with --confidence each frame must have one"));
}

TEST_F(Layout, WhatIsMissingIsNamed) {
  write_images("depth/{}.png");
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path()); }), HasSubstr("has 4 depth images but no poses"));
  write_file_atomically(folder / "traj.txt", rows(pose_number(0).matrix(), 3, " "));
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path()); }),
              HasSubstr("has no intrinsics; must have one of"));
}

}  // namespace
}  // namespace vantage
