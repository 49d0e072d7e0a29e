#include "vantage/server/scan_upload.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/formats/png16.hpp"
#include "vantage/server/multipart.hpp"

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

TEST(Multipart, FindsThePartsOfABody) {
  // The example of RFC 7578, section 4.3, without its nesting, and a body with dashes and line ends in it.
  const std::string body =
      "--AaB03x\r\ncontent-disposition: form-data; name=\"field1\"\r\n\r\nJoe Blow\r\n--AaB03x\r\n"
      "Content-Type: text/plain\r\nContent-Disposition: form-data; name=\"pics\"; filename=\"file1.txt\"\r\n\r\n"
      "--AaB03x\r\n\r\n--\r\n--AaB03x--\r\n";
  const std::vector<FormPart> parts = parse_multipart(body);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "field1");
  EXPECT_EQ(parts[0].body, "Joe Blow");
  EXPECT_EQ(parts[1].file_name, "file1.txt");
  EXPECT_EQ(parts[1].body, "--AaB03x\r\n\r\n--");
  EXPECT_THAT(input_error_of([&] { (void)parse_multipart(body.substr(0, body.size() - 12)); }),
              HasSubstr("is cut off"));
  EXPECT_THAT(input_error_of([] { (void)parse_multipart(""); }), HasSubstr("must begin with its boundary"));
}

TEST(ScanUpload, ReadsADepthImageWithPoseAndIntrinsics) {
  const SessionScan scan = parse_scan_upload(depth_upload(), {});
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
  const SessionScan scan = parse_scan_upload(body + "--B--\r\n", {});
  EXPECT_EQ(scan.key, "frame 7");
  ASSERT_TRUE(scan.commanded);
  EXPECT_EQ(scan.commanded->position(), Vec3(1, 2, 3.5));
  EXPECT_THAT(std::get<ImageScan>(scan.scan).image.depth, testing::ElementsAre(0.0F, 0.0F, 2.0F, 3.0F));
  const auto refused = [](const std::string& parts) {
    return input_error_of([&] { (void)parse_scan_upload(parts + "--B--\r\n", {}); });
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
  const SessionScan scan = parse_scan_upload(body, upload_options(options));
  EXPECT_LT((scan.believed.position() - Vec3(0.001, 0.002, 0.103)).norm(), 1e-12);
  EXPECT_LT((scan.believed.world_from_sensor.linear() - Vec3(-1, -1, 1).asDiagonal().toDenseMatrix()).norm(), 1e-12);
  EXPECT_LT((std::get<PointScan>(scan.scan).points.at(0) - Vec3(0.01, 0.02, 0.3)).norm(), 1e-12);
}

TEST(ScanUpload, LeavesOutWhatLiesOutsideTheCropBox) {
  ScanFolderOptions options;
  // Pixel (1, 0) at 1 m is at z = 4 of the world, (0, 1) at 2 m at z = 5, (1, 1) at 3 m at z = 6.
  options.crop = Eigen::Matrix<double, 6, 1>{{1.0, 2.0, 5.0, 4.0, 4.0, 1.0}};
  const SessionScan scan = parse_scan_upload(depth_upload(), upload_options(options));
  EXPECT_THAT(std::get<ImageScan>(scan.scan).image.depth, testing::ElementsAre(0.0F, 0.0F, 2.0F, 0.0F));
}

TEST(ScanUpload, AnyBytesAreReadOrRefused) {
  const FuzzCount count =
      read_damaged(depth_upload(), 3000, [](const std::string& bytes) { (void)parse_scan_upload(bytes, {}); });
  EXPECT_EQ(count.accepted + count.refused, 3000);
  EXPECT_GT(count.refused, 1000);
  EXPECT_GT(count.accepted, 10);
}

}  // namespace
}  // namespace vantage
