// What the options of reading do to scans, against values computed by hand.

#include <gmock/gmock.h>

#include <cstring>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/recordings/scan_bytes.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

// A camera of 40x30 pixels with f = 40 in the middle of them, and a wall 1 m before it: pixel (u, v) meets it at
// x = (u - 19.5) / 40, y = (v - 14.5) / 40.
constexpr Resolution size{40, 30};
RangeCamera small_camera() { return camera_from_intrinsics(40, 40, 19.5, 14.5, size); }

Pose moved(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

/// A folder with the wall as NAME.depth.png in millimetres, seen from `pose`.
void write_wall(const TestFolder& folder, const Pose& pose) {
  write_file_atomically(folder / "camera-intrinsics.txt", "40 0 19.5\n0 40 14.5\n0 0 1\n");
  write_depth_png(folder / "a.depth.png", {small_camera(), std::vector<float>(1200, 1.0F)});
  write_pose(folder / "a.pose.txt", pose);
}

RangeImage image_of(const TestFolder& folder, const ScanFolderOptions& options) {
  return std::get<ImageScan>(open_scans(folder.path(), options).scans.at(0).read()).image;
}

Vec3 position_of(const TestFolder& folder, const ScanFolderOptions& options) {
  return open_scans(folder.path(), options).scans.at(0).view.position();
}

/// The pixels that are not unknown: how many, and the box of columns and rows around them.
struct Known {
  int count = 0, left = 1000, right = -1, top = 1000, bottom = -1;
  friend bool operator==(const Known&, const Known&) = default;
};

Known known_in(const RangeImage& image) {
  Known known;
  for (int v = 0; v < size.rows; ++v) {
    for (int u = 0; u < size.columns; ++u) {
      if (image.at(u, v) == RangeImage::unknown) continue;
      known = {known.count + 1, std::min(known.left, u), std::max(known.right, u), std::min(known.top, v),
               std::max(known.bottom, v)};
    }
  }
  return known;
}

std::string float32(const std::vector<float>& values) {
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

TEST(ScanReading, TheUnitIsThatOfPosesCloudsAndFloats) {
  const TestFolder folder;
  write_file_atomically(folder / "camera.json",
                        R"({"width": 40, "height": 30, "intrinsic_matrix": [40, 0, 0, 0, 40, 0, 19.5, 14.5, 1]})");
  write_file_atomically(folder / "a.depth.raw", float32(std::vector<float>(1200, 250.0F)));
  write_pose(folder / "a.pose.txt", moved(1000, 2000, -3000));
  EXPECT_FLOAT_EQ(image_of(folder, {.unit = "mm"}).at(3, 4), 0.25F);
  EXPECT_FLOAT_EQ(image_of(folder, {.unit = "cm"}).at(3, 4), 2.5F);
  EXPECT_FLOAT_EQ(image_of(folder, {.depth_range = {0, 10}, .unit = "inch"}).at(3, 4), 6.35F);
  EXPECT_TRUE(position_of(folder, {.unit = "mm"}).isApprox(Vec3(1, 2, -3)));
  EXPECT_TRUE(position_of(folder, {.unit = "inch"}).isApprox(Vec3(25.4, 50.8, -76.2)));
  const TestFolder clouds;
  write_file_atomically(clouds / "b.xyz", "0 0 1000\n100 0 1000\n");
  write_pose(clouds / "b.pose.txt", moved(1000, 0, 0));
  const auto cloud = std::get<PointScan>(open_scans(clouds.path(), {.unit = "mm"}).scans.at(0).read());
  EXPECT_EQ(cloud.points, (std::vector<Vec3>{{0, 0, 1}, {0.1, 0, 1}}));
  EXPECT_EQ(input_error_of([&] { (void)open_scans(clouds.path(), {.unit = "feet"}); }),
            "unit = 'feet': must be m, cm, mm or inch");
}

TEST(ScanReading, UnitsOfAnImageAreThoseOfTheDepthScale) {
  const TestFolder folder;
  write_wall(folder, moved(1, 2, 3));
  // 1000 units of 0.1 mm; the unit of the poses plays no part.
  EXPECT_FLOAT_EQ(image_of(folder, {.depth_scale = 0.0001, .unit = "cm"}).at(0, 0), 0.1F);
  EXPECT_TRUE(position_of(folder, {.unit = "cm"}).isApprox(Vec3(0.01, 0.02, 0.03)));
}

TEST(ScanReading, TheSensorSitsInTheHand) {
  const TestFolder folder;
  // The hand is at (1, 2, 3) and turned by 90 degrees about z: its x axis is the world's y axis.
  Pose hand = moved(1, 2, 3);
  hand.linear() = Eigen::AngleAxisd(radians(90), Vec3::UnitZ()).toRotationMatrix();
  write_wall(folder, hand);
  const ScanFolderOptions by_numbers{.hand_eye = "0.1,0,0.05,0,0,0,1"};
  EXPECT_TRUE(position_of(folder, by_numbers).isApprox(Vec3(1, 2.1, 3.05)));
  // Turned by 180 degrees about x (quaternion 1 0 0 0): the sensor looks down, its y axis is minus the hand's.
  const ScanFolderOptions turned{.hand_eye = "0.1,0,0.05,1,0,0,0"};
  const Pose pose = open_scans(folder.path(), turned).scans.at(0).view.world_from_sensor;
  EXPECT_TRUE(pose.translation().isApprox(Vec3(1, 2.1, 3.05)));
  EXPECT_TRUE(pose.linear().col(2).isApprox(Vec3(0, 0, -1)));
  EXPECT_TRUE(pose.linear().col(1).isApprox(Vec3(1, 0, 0)));
  write_pose(folder / "offset.txt", moved(100, 0, 50));
  hand.translation() *= 1000;
  write_pose(folder / "a.pose.txt", hand);
  EXPECT_TRUE(
      position_of(folder, {.unit = "mm", .hand_eye = (folder / "offset.txt").string()}).isApprox(Vec3(1, 2.1, 3.05)));
  const auto error = [&](const std::string& offset) {
    return input_error_of([&] { (void)open_scans(folder.path(), {.hand_eye = offset}); });
  };
  EXPECT_EQ(error("1,2,3"), "hand-eye: '1,2,3' has 3 numbers; must have 7");
  EXPECT_EQ(error("1,2,3,0,0,0,2"), "hand-eye: the quaternion has length 2, must be 1");
  EXPECT_THAT(error((folder / "none.txt").string()), HasSubstr("none.txt: cannot be read"));
  EXPECT_THAT(error((folder / "camera-intrinsics.txt").string()), HasSubstr("camera-intrinsics.txt"));
}

TEST(ScanReading, TheCropBoxIsInTheWorld) {
  const TestFolder folder;
  write_wall(folder, moved(5, 0, 0));
  // x within 0.1 of the axis: u in 15.5 .. 23.5; y within 0.05: v in 12.5 .. 16.5.
  ScanFolderOptions options;
  options.crop = Eigen::Matrix<double, 6, 1>{{5, 0, 1, 0.2, 0.1, 0.5}};
  EXPECT_EQ(known_in(image_of(folder, options)), (Known{8 * 4, 16, 23, 13, 16}));
  options.crop = Eigen::Matrix<double, 6, 1>{{5, 0, 2, 0.2, 0.1, 0.5}};
  EXPECT_EQ(known_in(image_of(folder, options)).count, 0) << "the wall is not in the box";
  const TestFolder clouds;
  write_file_atomically(clouds / "b.xyzn", "0 0 1 0 0 -1\n0.2 0 1 0 0 -1\n0 0.04 1 0 0 -1\n");
  write_pose(clouds / "b.pose.txt", moved(5, 0, 0));
  options.crop = Eigen::Matrix<double, 6, 1>{{5, 0, 1, 0.2, 0.1, 0.5}};
  const auto cloud = std::get<PointScan>(open_scans(clouds.path(), options).scans.at(0).read());
  EXPECT_EQ(cloud.points, (std::vector<Vec3>{{0, 0, 1}, {0, 0.04, 1}}));
  EXPECT_EQ(cloud.normals.size(), 2U);
  options.crop = Eigen::Matrix<double, 6, 1>{{5, 0, 1, 0.2, 0, 0.5}};
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), options); }),
              HasSubstr("crop: must be cx,cy,cz,sx,sy,sz with positive sizes"));
}

TEST(ScanReading, BlackPixelsOfAMaskAreUnknown) {
  const TestFolder folder;
  write_wall(folder, moved(0, 0, 0));
  Gray16 mask{size, std::vector<std::uint16_t>(1200, 0)};
  for (int v = 10; v < 20; ++v) {
    for (int u = 5; u < 9; ++u) mask.values[static_cast<std::size_t>(40 * v + u)] = 1;
  }
  std::filesystem::create_directory(folder / "masks");
  write_file_atomically(folder / "masks" / "a.mask.png", encode_png16(mask));
  EXPECT_EQ(known_in(image_of(folder, {})).count, 1200) << "none lies beside the frame";
  EXPECT_EQ(known_in(image_of(folder, {.masks = "masks"})), (Known{40, 5, 8, 10, 19}));
  write_file_atomically(folder / "a.mask.png", encode_png16(mask));
  EXPECT_EQ(known_in(image_of(folder, {})), (Known{40, 5, 8, 10, 19}));
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), {.masks = "nowhere"}); }),
              HasSubstr("nowhere/a.mask.png: there is no such file; with --masks each frame must have one"));
  write_file_atomically(folder / "a.mask.png", encode_png16({{30, 40}, std::vector<std::uint16_t>(1200, 1)}));
  EXPECT_THAT(input_error_of([&] { (void)image_of(folder, {}); }),
              HasSubstr("a.mask.png: has 30x40 pixels, the depth image 40x30; a mask must have the same"));
  write_file_atomically(folder / "a.mask.png", "P5 40 30");
  EXPECT_THAT(input_error_of([&] { (void)image_of(folder, {}); }), HasSubstr("a.mask.png: is not a PNG file"));
}

TEST(ScanReading, MasksMayBeAnyKindOfPng) {
  int files = 0;
  const std::vector<std::pair<std::string, Mask>> masks{{"grey8", {1, 0, 1, 0, 0, 1}},   {"grey1", {1, 0, 1, 0, 0, 1}},
                                                        {"grey16", {1, 0, 1, 0, 0, 1}},  {"colour", {1, 0, 1, 0, 0, 1}},
                                                        {"palette", {1, 0, 1, 0, 0, 1}}, {"alpha", {0, 1, 0, 1, 1, 1}}};
  for (const auto& [name, wanted] : masks) {
    const std::string path = concat(VANTAGE_FUZZ_CORPUS, "/image/mask_png/", name);
    EXPECT_EQ(decode_png_mask(read_file(path), {3, 2}, path), wanted) << name;
    ++files;
  }
  EXPECT_EQ(files, 6);
}

TEST(ScanReading, OpenExrImagesAreFramesToo) {
  const TestFolder folder;
  // Written by OpenEXR: 24x18 pixels, 0.5 + u + 10 v.
  std::filesystem::copy_file(concat(VANTAGE_FUZZ_CORPUS, "/image/exr/openexr-zip"), folder / "a.depth.exr");
  write_file_atomically(folder / "camera-intrinsics.txt", "40 0 11.5\n0 40 8.5\n0 0 1\n");
  write_pose(folder / "a.pose.txt", moved(0, 0, 0));
  const RangeImage image = image_of(folder, {.depth_range = {0, 1}, .unit = "cm"});
  EXPECT_EQ(image.camera.resolution, (Resolution{24, 18}));
  EXPECT_FLOAT_EQ(image.at(3, 7), 0.735F);
  EXPECT_EQ(image.at(0, 10), RangeImage::no_return) << "1.005 m is beyond the limit";
  write_file_atomically(folder / "camera-intrinsics.json",
                        R"({"width": 40, "height": 30, "intrinsic_matrix": [40, 0, 0, 0, 40, 0, 19.5, 14.5, 1]})");
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), {.intrinsics = "camera-intrinsics.json"}); }),
              HasSubstr("the intrinsics are for 40x30 pixels, the image has 24x18"));
}

TEST(ScanReading, CloudsOfTheWorldAreSeenFromTheirPose) {
  const TestFolder folder;
  write_file_atomically(folder / "a.xyzn", "1 2 3 0 0 1\n");
  Pose pose = moved(1, 2, 5);
  pose.linear() = Eigen::AngleAxisd(radians(180), Vec3::UnitX()).toRotationMatrix();
  write_pose(folder / "a.pose.txt", pose);
  const ScanSet set = open_scans(folder.path(), {.cloud_frame = "world"});
  const auto cloud = std::get<PointScan>(set.scans.at(0).read());
  EXPECT_TRUE(cloud.points.at(0).isApprox(Vec3(0, 0, 2))) << "2 m below the sensor, which looks down";
  EXPECT_TRUE(cloud.normals.at(0).isApprox(Vec3f(0, 0, -1)));
  EXPECT_TRUE(set.scans.at(0).view.position().isApprox(Vec3(1, 2, 5)));
  EXPECT_THAT(input_error_of([&] { (void)open_scans(folder.path(), {.cloud_frame = "map"}); }),
              HasSubstr("cloud-frame = 'map': must be sensor or world"));
}

}  // namespace
}  // namespace vantage
