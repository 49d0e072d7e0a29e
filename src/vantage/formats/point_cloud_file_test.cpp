#include "vantage/formats/point_cloud_file.hpp"

#include <gmock/gmock.h>
#include <lzf.h>

#include <cmath>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

// Four cells of which one has no measurement; the second normal is meaningless.
const std::string pcd_header = R"(# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z rgb normal_x normal_y normal_z
SIZE 4 4 4 4 4 4 4
TYPE F F F U F F F
COUNT 1 1 1 1 1 1 1
WIDTH 2
HEIGHT 2
VIEWPOINT 1 2 3 0 0 0 1
POINTS 4
)";
const std::string ascii_pcd = pcd_header + R"(DATA ascii
1 2 3 4278190080 0 0 2
4 5 6 0 nan nan nan
nan nan nan 0 0 0 0
7 8 9 0 -1 0 0
)";

/// The points of `ascii_pcd` as 28-byte records.
std::vector<std::string> records() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::string> result;
  for (const std::array<float, 7>& row : {std::array<float, 7>{1, 2, 3, 0, 0, 0, 2},
                                          {4, 5, 6, 0, nan, nan, nan},
                                          {nan, nan, nan, 0, 0, 0, 0},
                                          {7, 8, 9, 0, -1, 0, 0}}) {
    std::string record;
    for (const float value : row) append_float32(record, static_cast<double>(value));
    result.push_back(record);
  }
  return result;
}

std::string binary_pcd() {
  std::string bytes = pcd_header + "DATA binary\n";
  for (const std::string& record : records()) bytes += record;
  return bytes;
}

std::string compressed_pcd() {
  std::string plain;
  for (std::size_t field = 0; field < 7; ++field) {
    for (const std::string& record : records()) plain += record.substr(4 * field, 4);
  }
  std::string packed(2 * plain.size(), '\0');
  packed.resize(::lzf_compress(plain.data(), static_cast<unsigned>(plain.size()), packed.data(),
                               static_cast<unsigned>(packed.size())));
  std::string bytes = pcd_header + "DATA binary_compressed\n";
  append_int32(bytes, static_cast<std::int32_t>(packed.size()));
  append_int32(bytes, static_cast<std::int32_t>(plain.size()));
  return bytes + packed;
}

const std::string range_grid_ply = R"(ply
format ascii 1.0
obj_info num_cols 3
obj_info num_rows 2
element vertex 2
property float x
property float y
property float z
element range_grid 6
property list uchar int vertex_indices
end_header
1 2 3
4 5 6
0
1 1
0
0
0
1 0
)";

std::string error_in(std::string_view bytes, CloudFormat format) {
  return input_error_of([&] { (void)parse_cloud(bytes, format, "a.cloud"); });
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

TEST(PointCloudFile, AllEncodingsOfPcdGiveTheSamePoints) {
  for (const std::string& bytes : {ascii_pcd, binary_pcd(), compressed_pcd()}) {
    const CloudFile file = parse_cloud(bytes, CloudFormat::pcd, "a.pcd");
    EXPECT_EQ(file.cloud.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_EQ(file.cloud.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 0}, {-1, 0, 0}}));
    EXPECT_EQ(file.grid, (Resolution{2, 2}));
    EXPECT_EQ(file.point_of_cell, (std::vector<std::int32_t>{0, 1, -1, 2}));
    EXPECT_EQ(file.cloud_from_sensor.translation(), Vec3(1, 2, 3));
    EXPECT_TRUE(file.cloud_from_sensor.linear().isApprox(Vec3(-1, -1, 1).asDiagonal().toDenseMatrix()))
        << "half a turn about z";
  }
}

TEST(PointCloudFile, FieldsWithSeveralValuesAreSkippedRightly) {
  const std::string text =
      "FIELDS histogram z y x\nSIZE 4 8 4 4\nTYPE F F F F\nCOUNT 3 1 1 1\nWIDTH 1\nHEIGHT 1\nDATA ascii\n9 9 9 3 2 1\n";
  EXPECT_EQ(parse_cloud(text, CloudFormat::pcd, "a.pcd").cloud.points, (std::vector<Vec3>{{1, 2, 3}}));
}

TEST(PointCloudFile, TextHasPointsAndMaybeNormals) {
  const std::string text = "# x y z and more\n1 2 3 0 0 5\n\n4\t5\t6 1 0 0\r\n";
  const PointCloud plain = parse_cloud(text, CloudFormat::xyz, "a.xyz").cloud;
  EXPECT_EQ(plain.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(plain.normals, (std::vector<Vec3>{{0, 0, 0}, {0, 0, 0}}));
  const PointCloud with_normals = parse_cloud(text, CloudFormat::xyzn, "a.xyzn").cloud;
  EXPECT_EQ(with_normals.points, plain.points);
  EXPECT_EQ(with_normals.normals, (std::vector<Vec3>{{0, 0, 1}, {1, 0, 0}}));
}

TEST(PointCloudFile, ARangeGridMakesAPlyOrganised) {
  const CloudFile file = parse_cloud(range_grid_ply, CloudFormat::ply, "a.ply");
  EXPECT_EQ(file.cloud.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(file.grid, (Resolution{3, 2}));
  EXPECT_EQ(file.point_of_cell, (std::vector<std::int32_t>{-1, 1, -1, -1, -1, 0}));
}

TEST(PointCloudFile, WhatIsWrittenIsReadAndHasThePromisedLayout) {
  const TestFolder folder;
  PointCloud cloud;
  cloud.add({0.5, -1.25, 2}, {0, 0, -1});
  cloud.add({1, 2, 3}, {0, 0, 0});
  write_cloud_ply(folder / "model.ply", cloud);
  const CloudFile again = read_cloud(folder / "model.ply");
  EXPECT_EQ(again.cloud.points, cloud.points);
  EXPECT_EQ(again.cloud.normals, cloud.normals);
  EXPECT_EQ(again.grid, (Resolution{0, 0}));
  const std::string bytes = read_file(folder / "model.ply");
  EXPECT_EQ(
      bytes.substr(0, bytes.size() - 48),
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nend_header\n");
  EXPECT_EQ(bytes.substr(bytes.size() - 48, 8), std::string("\0\0\0\x3f\0\0\xa0\xbf", 8)) << "0.5 and -1.25";
  cloud.normals.pop_back();
  EXPECT_THAT(input_error_of([&] { write_cloud_ply(folder / "bad.ply", cloud); }), HasSubstr("2 points has 1 normals"));
}

TEST(PointCloudFile, BadPcdIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) { return error_in(bytes, CloudFormat::pcd); };
  EXPECT_EQ(error(""), "a.cloud: is empty");
  EXPECT_THAT(error("hello"), HasSubstr("line 1: 'hello' is no keyword of a PCD header"));
  EXPECT_THAT(error(pcd_header), HasSubstr("ends without 'DATA'"));
  EXPECT_THAT(error(pcd_header + "DATA zip\n"), HasSubstr("DATA 'zip': must be ascii, binary or binary_compressed"));
  EXPECT_THAT(error(replaced(ascii_pcd, "SIZE 4", "SIZE 3")), HasSubstr("SIZE 3: must be 1, 2, 4 or 8"));
  EXPECT_THAT(error(replaced(ascii_pcd, "SIZE 4", "SIZE 2")), HasSubstr("field 'x': F needs SIZE 4 or 8"));
  EXPECT_THAT(error(replaced(ascii_pcd, "TYPE F", "TYPE X")), HasSubstr("TYPE 'X': must be F, I or U"));
  EXPECT_THAT(error(replaced(ascii_pcd, "COUNT 1", "COUNT 0")), HasSubstr("COUNT 0: must be within 1 and 1024"));
  EXPECT_THAT(error(replaced(ascii_pcd, "WIDTH 2", "WIDTH 3")), HasSubstr("POINTS 4: must be WIDTH times HEIGHT, 6"));
  EXPECT_THAT(error(replaced(ascii_pcd, "WIDTH 2", "WIDTH 0")),
              HasSubstr("WIDTH and HEIGHT must be given and positive"));
  EXPECT_THAT(error(replaced(ascii_pcd, "WIDTH 2", "WIDTH 99999999999")),
              HasSubstr("WIDTH 99999999999: must be at most"));
  EXPECT_THAT(error(replaced(ascii_pcd, "VIEWPOINT 1", "VIEWPOINT nan")),
              HasSubstr("VIEWPOINT = nan: must be a finite"));
  EXPECT_THAT(error(replaced(ascii_pcd, "0 0 0 1\n", "0 0 0 2\n")),
              HasSubstr("VIEWPOINT: the quaternion has length 2, must be 1"));
  EXPECT_THAT(error(replaced(ascii_pcd, "FIELDS x", "FIELDS u")), HasSubstr("FIELDS must have x, y and z"));
  EXPECT_THAT(error(replaced(ascii_pcd, "4 5 6", "4 5 six")), HasSubstr("line 13: z = 'six': must be a number"));
  EXPECT_THAT(error(replaced(ascii_pcd, "7 8 9 0 -1 0 0\n", "")), HasSubstr("ends after 3 of 4 points"));
  const std::string binary = binary_pcd();
  EXPECT_THAT(error(binary.substr(0, binary.size() - 1)),
              HasSubstr("4 points of 28 bytes are announced, but only 111 bytes follow; the file is cut off"));
  std::string compressed = compressed_pcd();
  EXPECT_THAT(error(compressed.substr(0, compressed.size() - 1)),
              HasSubstr("compressed bytes are announced, but only"));
  const std::size_t start = compressed.find("compressed\n") + 11;
  std::string wrong_size = compressed;
  wrong_size[start + 7] = '\x7f';
  EXPECT_THAT(error(wrong_size), HasSubstr("the header asks for 112"));
  compressed[start + 8] = '\xff';  // a reference to bytes before the first
  EXPECT_THAT(error(compressed), HasSubstr("the compressed points are damaged"));
}

TEST(PointCloudFile, BadCloudsOfOtherFormatsAreRefused) {
  EXPECT_THAT(error_in("1 2\n", CloudFormat::xyz), HasSubstr("line 1: a coordinate is missing"));
  EXPECT_THAT(error_in("1 2 3\n", CloudFormat::xyzn), HasSubstr("line 1: a coordinate of the normal is missing"));
  EXPECT_THAT(error_in("# nothing\n", CloudFormat::xyz), HasSubstr("has no point with finite coordinates"));
  EXPECT_THAT(error_in("nan nan nan\n", CloudFormat::xyz), HasSubstr("has no point with finite coordinates"));
  const auto error = [](const std::string& bytes) { return error_in(bytes, CloudFormat::ply); };
  EXPECT_THAT(error(replaced(range_grid_ply, "num_cols 3", "num_cols 4")),
              HasSubstr("'range_grid' has 6 cells; must be num_cols times num_rows"));
  EXPECT_THAT(error(replaced(range_grid_ply, "obj_info num_cols 3\n", "")),
              HasSubstr("must be num_cols times num_rows"));
  EXPECT_THAT(error(replaced(range_grid_ply, "1 1\n", "1 2\n")),
              HasSubstr("cell 1 of 'range_grid' has the vertex 2: there are 2"));
  EXPECT_THAT(error(replaced(range_grid_ply, "1 1\n", "2 0 1\n")), HasSubstr("has 2 vertices, must be 0 or 1"));
  EXPECT_THAT(input_error_of([] { (void)read_cloud("scan.las"); }),
              HasSubstr("scan.las: a point cloud must be a .ply, .pcd"));
}

TEST(PointCloudFile, DamagedFilesAreReadOrRefused) {
  const auto damage = [](const std::string& bytes, CloudFormat format) {
    const FuzzCount count = read_damaged(bytes, 3000, [&](const std::string& damaged) {
      const CloudFile file = parse_cloud(damaged, format, "a");
      ASSERT_EQ(file.cloud.points.size(), file.cloud.normals.size());
      for (const Vec3& point : file.cloud.points) ASSERT_TRUE(point.allFinite());
    });
    EXPECT_EQ(count.accepted + count.refused, 3000);
    EXPECT_GT(count.refused, 500);
  };
  damage(ascii_pcd, CloudFormat::pcd);
  damage(binary_pcd(), CloudFormat::pcd);
  damage(compressed_pcd(), CloudFormat::pcd);
  damage(range_grid_ply, CloudFormat::ply);
  damage("1 2 3 0 0 1\n4 5 6 0 0 1\n7 8 9 1 0 0\n", CloudFormat::xyzn);
}

TEST(PointCloudFile, AStanfordScanIsRead) {
  const std::filesystem::path path = std::filesystem::path(VANTAGE_SHARED_DATA) / "scans/stanford_bunny/bun000.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
  const CloudFile file = read_cloud(path);
  EXPECT_EQ(file.cloud.size(), 40256U);
  EXPECT_EQ(file.grid, (Resolution{512, 400}));
  EXPECT_EQ(std::count_if(file.point_of_cell.begin(), file.point_of_cell.end(), [](int p) { return p >= 0; }), 40256);
}

}  // namespace
}  // namespace vantage
