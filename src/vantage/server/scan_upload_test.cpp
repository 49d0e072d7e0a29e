#include "vantage/server/scan_upload.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/formats/png16.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string part(const std::string& name, const std::string& body, const std::string& file = "") {
  return "--B\r\nContent-Disposition: form-data; name=\"" + name + "\"" +
         (file.empty() ? "" : "; filename=\"" + file + "\"") + "\r\n\r\n" + body + "\r\n";
}

const std::string identity = "1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n";
const std::string pinhole = "2 0 0.5\n0 2 0.5\n0 0 1\n";

/// Two by two pixels in millimetres: unknown, 1 m, 2 m, 3 m.
std::string depth_upload() {
  const std::string png = encode_png16({{2, 2}, {0, 1000, 2000, 3000}});
  return part("depth", png, "d.png") + part("pose", identity) + part("intrinsics", pinhole) + part("name", "one") +
         part("candidate", "7") + "--B--\r\n";
}

TEST(ScanUpload, ReadsADepthImageWithPoseAndIntrinsics) {
  const SessionScan scan = parse_scan_upload(depth_upload(), "B", {});
  EXPECT_EQ(scan.name, "one");
  EXPECT_EQ(scan.candidate, 7);
  EXPECT_EQ(scan.believed.position(), Vec3(1, 2, 3));
  EXPECT_THAT(std::get<ImageScan>(scan.scan).image.depth, testing::ElementsAre(0.0F, 1.0F, 2.0F, 3.0F));
}

TEST(ScanUpload, TakesAMaskACommandedPoseAndAKey) {
  std::string body = depth_upload();
  body.resize(body.size() - 7);  // without its end
  body += part("mask", encode_png16({{2, 2}, {1, 0, 1, 1}}), "m.png") + part("key", "frame 7") +
          part("commanded", "1 0 0 1\n0 1 0 2\n0 0 1 3.5\n0 0 0 1\n");
  const SessionScan scan = parse_scan_upload(body + "--B--\r\n", "B", {});
  EXPECT_EQ(scan.key, "frame 7");
  ASSERT_TRUE(scan.commanded);
  EXPECT_EQ(scan.commanded->position(), Vec3(1, 2, 3.5));
  EXPECT_THAT(std::get<ImageScan>(scan.scan).image.depth, testing::ElementsAre(0.0F, 0.0F, 2.0F, 3.0F));
  const auto refused = [](const std::string& parts) {
    return input_error_of([&] { (void)parse_scan_upload(parts + "--B--\r\n", "B", {}); });
  };
  const std::string wrong_mask = part("mask", encode_png16({{2, 1}, {1, 0}}));
  EXPECT_THAT(refused(part("depth", encode_png16({{2, 2}, {0, 1, 2, 3}})) + part("pose", identity) +
                      part("intrinsics", pinhole) + wrong_mask),
              HasSubstr("mask: has 2x1 pixels, the depth image 2x2"));
  EXPECT_THAT(refused(part("cloud", "1 2 3\n", "c.xyz") + part("pose", identity) + wrong_mask),
              HasSubstr("field 'mask': goes with 'depth'"));
}

TEST(ScanUpload, BringsCloudsIntoMetresAndTheSensorsFrame) {
  ScanFolderOptions options;
  options.unit = "mm";
  options.hand_eye = "0,0,100,0,0,1,0";  // a half turn about z, 100 mm ahead of the hand
  const std::string body = part("cloud", "10 20 300\n", "c.xyz") + part("pose", identity) + "--B--\r\n";
  const SessionScan scan = parse_scan_upload(body, "B", upload_options(options));
  EXPECT_LT((scan.believed.position() - Vec3(0.001, 0.002, 0.103)).norm(), 1e-12);
  EXPECT_LT((scan.believed.world_from_sensor.linear() - Vec3(-1, -1, 1).asDiagonal().toDenseMatrix()).norm(), 1e-12);
  EXPECT_LT((std::get<PointScan>(scan.scan).points.at(0) - Vec3(0.01, 0.02, 0.3)).norm(), 1e-12);
}

TEST(ScanUpload, LeavesOutWhatLiesOutsideTheCropBox) {
  ScanFolderOptions options;
  // Pixel (1, 0) at 1 m is at z = 4 of the world, (0, 1) at 2 m at z = 5, (1, 1) at 3 m at z = 6.
  options.crop = Eigen::Matrix<double, 6, 1>{{1.0, 2.0, 5.0, 4.0, 4.0, 1.0}};
  const SessionScan scan = parse_scan_upload(depth_upload(), "B", upload_options(options));
  EXPECT_THAT(std::get<ImageScan>(scan.scan).image.depth, testing::ElementsAre(0.0F, 0.0F, 2.0F, 0.0F));
}

std::string refusal_of(const std::string& parts, const UploadOptions& options = {}) {
  return input_error_of([&] { (void)parse_scan_upload(parts + "--B--\r\n", "B", options); });
}

TEST(ScanUpload, LimitsWhatIsUnpackedAndParsed) {
  // 8192x8192 pixels in 65 KB; the same for a mask and a cloud: refused by what their headers announce.
  const std::string rest = part("pose", identity) + part("intrinsics", pinhole);
  const std::string bomb = encode_png16({{8192, 8192}, std::vector<std::uint16_t>(std::size_t{8192} * 8192)});
  EXPECT_THAT(refusal_of(part("depth", bomb) + rest),
              HasSubstr("depth: has 8192x8192 pixels; must have at most 16777216"));
  UploadOptions small;
  small.most_pixels = 3;
  small.most_values = 30;
  EXPECT_THAT(refusal_of(part("depth", encode_png16({{2, 2}, {0, 1, 2, 3}})) + rest, small), HasSubstr("at most 3"));
  EXPECT_THAT(refusal_of(part("depth", encode_png16({{1, 2}, {1, 2}})) + rest + part("mask", bomb)),
              HasSubstr("mask: has 8192x8192"));
  std::string points;
  for (int i = 0; i < 11; ++i) points += "1 2 3\n";
  const std::string header = "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 11\nHEIGHT 1\nDATA ascii\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 11\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const auto& [name, text] : {std::pair{"a.xyz", points}, {"a.pcd", header + points}, {"a.ply", ply + points}}) {
    const std::string form = part("cloud", text, name) + part("pose", identity);
    EXPECT_THAT(refusal_of(form, small), HasSubstr("cloud: has")) << name;
    EXPECT_NO_THROW((void)parse_scan_upload(form + "--B--\r\n", "B", {})) << name;
  }
  std::string yaml = "a: [";
  while (yaml.size() < 20000) yaml += "x,";
  EXPECT_THAT(refusal_of(part("depth", "x") + part("pose", identity) + part("intrinsics", yaml + "]")),
              HasSubstr("field 'intrinsics': has"));
  EXPECT_THAT(refusal_of(part("depth", "x") + part("pose", std::string(5000, ' ')) + part("intrinsics", pinhole)),
              HasSubstr("field 'pose': has 5000 bytes; must have at most 4096"));
}

TEST(ScanUpload, NamesAndKeysAreTextOfOneLine) {
  const std::string frame =
      part("depth", encode_png16({{2, 2}, {0, 1, 2, 3}})) + part("pose", identity) + part("intrinsics", pinhole);
  EXPECT_THAT(refusal_of(frame + part("key",
                                      "Gr\xf6\xdf"
                                      "e")),
              HasSubstr("field 'key': is not UTF-8: Gr\\xf6"));
  EXPECT_THAT(refusal_of(frame + part("name", "\x1b[2J")), HasSubstr("field 'name': has control characters: \\x1b[2J"));
  EXPECT_EQ(parse_scan_upload(frame +
                                  part("key",
                                       "Gr\xc3\xb6\xc3\x9f"
                                       "e") +
                                  "--B--\r\n",
                              "B", {})
                .key,
            "Gr\xc3\xb6\xc3\x9f"
            "e");
}

TEST(ScanUpload, AnyBytesAreReadOrRefused) {
  const FuzzCount count =
      read_damaged(depth_upload(), 3000, [](const std::string& bytes) { (void)parse_scan_upload(bytes, "B", {}); });
  EXPECT_EQ(count.accepted + count.refused, 3000);
  EXPECT_GT(count.refused, 1000);
  EXPECT_GT(count.accepted, 10);
}

}  // namespace
}  // namespace vantage
