#include "vantage/formats/camera_file.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string text_matrix = "5.3258e+02 0 316.04\n0 532.21 236.03\n0 0 1\n";
const std::string calibration = R"(image_width: 640
image_height: 480
camera_name: depth
camera_matrix:
  rows: 3
  cols: 3
  data: [532.58, 0., 316.04, 0., 532.21, 236.03, 0., 0., 1.]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, -0.2, 0.001, -0.002, 0.05]
)";
const std::string message = R"(header: {seq: 1, frame_id: "camera"}
height: 480
width: 640
distortion_model: "plumb_bob"
D: [0.0, 0.0, 0.0, 0.0, 0.0]
K: [532.58, 0.0, 316.04, 0.0, 532.21, 236.03, 0.0, 0.0, 1.0]
)";
const std::string open3d = R"({"width": 640, "height": 480,
 "intrinsic_matrix": [532.58, 0, 0, 0, 532.21, 0, 316.04, 236.03, 1]})";

void expect_intrinsics(const Intrinsics& k) {
  EXPECT_EQ(k.fx, 532.58);
  EXPECT_EQ(k.fy, 532.21);
  EXPECT_EQ(k.cx, 316.04);
  EXPECT_EQ(k.cy, 236.03);
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

TEST(CameraFile, AllFormatsGiveTheSameIntrinsics) {
  const Intrinsics text = parse_intrinsics_text(text_matrix, "a.txt");
  expect_intrinsics(text);
  EXPECT_FALSE(text.resolution.has_value());
  const Intrinsics yaml = parse_intrinsics_yaml(calibration, "a.yaml");
  expect_intrinsics(yaml);
  EXPECT_EQ(yaml.resolution, (Resolution{640, 480}));
  EXPECT_THAT(yaml.distortion, ElementsAre(0.1, -0.2, 0.001, -0.002, 0.05));
  EXPECT_TRUE(yaml.is_distorted());
  for (const std::string& bytes : {message, replaced(replaced(message, "D:", "d:"), "K:", "k:")}) {
    const Intrinsics printed = parse_intrinsics_yaml(bytes, "a.yaml");
    expect_intrinsics(printed);
    EXPECT_EQ(printed.resolution, (Resolution{640, 480}));
    EXPECT_FALSE(printed.is_distorted());
  }
  const Intrinsics json = parse_intrinsics_json(open3d, "a.json");
  expect_intrinsics(json);
  EXPECT_EQ(json.resolution, (Resolution{640, 480}));
}

TEST(CameraFile, TheEndingOfTheNameChoosesTheFormat) {
  const TestFolder folder;
  const auto read = [&](const std::string& name, const std::string& bytes) {
    write_file_atomically(folder / name, bytes);
    return read_intrinsics(folder / name);
  };
  expect_intrinsics(read("a.txt", text_matrix));
  expect_intrinsics(read("a.yaml", calibration));
  expect_intrinsics(read("a.yml", calibration));
  expect_intrinsics(read("a.json", open3d));
  EXPECT_THAT(input_error_of([&] { (void)read_intrinsics(folder / "a.xml"); }),
              HasSubstr("a.xml: intrinsics must be a .txt (3x3), .yaml"));
}

TEST(CameraFile, ThePinholeCameraMustBeOfTheImagesResolution) {
  const Intrinsics intrinsics = parse_intrinsics_json(open3d, "a.json");
  const RangeCamera camera = pinhole_camera(intrinsics, {640, 480});
  EXPECT_NEAR(camera.rays().x(100), (100 - 316.04) / 532.58, 1e-12);
  EXPECT_NEAR(camera.rays().y(400), (400 - 236.03) / 532.21, 1e-12);
  EXPECT_EQ(input_error_of([&] {
              (void)pinhole_camera(intrinsics, {1280, 720});
            }),
            "the intrinsics are for 640x480 pixels, the image has 1280x720");
}

TEST(CameraFile, BadTextIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) {
    return input_error_of([&] { (void)parse_intrinsics_text(bytes, "a.txt"); });
  };
  EXPECT_THAT(error(""), HasSubstr("a.txt: has 0 rows, must be 3 rows of 3 numbers (fx 0 cx, 0 fy cy, 0 0 1)"));
  EXPECT_EQ(error("500 0\n"), "a.txt, line 1: number 3 of row 1 is missing");
  EXPECT_EQ(error("500 0 320 1\n"), "a.txt, line 1: '1' is a fourth number, must be 3 per row");
  EXPECT_THAT(error(text_matrix + "0 0 1\n"), HasSubstr("a fourth row"));
  EXPECT_THAT(error(replaced(text_matrix, "236.03", "nan")),
              HasSubstr("line 2: number 3 of row 2 = nan: must be a finite number"));
  EXPECT_THAT(error("500 0 0\n0 500 0\n320 240 1\n"),
              HasSubstr("the last row of the camera matrix is 320 240 1, must be 0 0 1 (is the matrix transposed?)"));
  EXPECT_THAT(error(replaced(text_matrix, "5.3258e+02 0", "5.3258e+02 3")), HasSubstr("has a skew (3, 0), must be 0"));
  EXPECT_THAT(error(replaced(text_matrix, "532.21", "-532.21")),
              HasSubstr("a.txt: fx = 532.58, fy = -532.21: focal lengths must be positive"));
}

TEST(CameraFile, BadYamlAndJsonAreRefusedWithPlaceAndReason) {
  const auto yaml = [](const std::string& bytes) {
    return input_error_of([&] { (void)parse_intrinsics_yaml(bytes, "a.yaml"); });
  };
  EXPECT_THAT(yaml(""), HasSubstr("a.yaml: is not a ROS camera_info file"));
  EXPECT_THAT(yaml("a: [1"), HasSubstr("a.yaml, line"));
  EXPECT_THAT(yaml("a: 1"), HasSubstr("a.yaml: has no 'camera_matrix' (calibration file) or 'K' (message)"));
  EXPECT_THAT(yaml("K: 5"), HasSubstr("a.yaml, line 1: camera_matrix must be a list of numbers"));
  EXPECT_THAT(yaml("K: [1, 2]"), HasSubstr("camera_matrix has 2 numbers, must be 9"));
  EXPECT_THAT(yaml(replaced(message, "532.58", "wide")),
              HasSubstr("a.yaml, line 6: camera_matrix = 'wide': must be a finite number"));
  EXPECT_THAT(yaml(replaced(message, "width: 640", "width: 0")),
              HasSubstr("the image is 0x480: both must be whole numbers within 1"));
  EXPECT_THAT(yaml(replaced(message, "width: 640", "width: 310")),
              HasSubstr("principal point (316.04, 236.03) lies outside the 310x480 image"));
  EXPECT_THAT(yaml(replaced(calibration, "plumb_bob", "equidistant")),
              HasSubstr("distortion_model 'equidistant': must be plumb_bob or rational_polynomial"));
  EXPECT_THAT(yaml(replaced(calibration, "data: [0.1,", "data: [1,2,3,4,5,")),
              HasSubstr("has 9 distortion coefficients, must be at most 8"));
  const auto json = [](const std::string& bytes) {
    return input_error_of([&] { (void)parse_intrinsics_json(bytes, "a.json"); });
  };
  EXPECT_THAT(json("{}"), HasSubstr("a.json: is not an Open3D camera (must be an object with 'intrinsic_matrix')"));
  EXPECT_THAT(json(R"({"intrinsic_matrix": [1, 2]})"), HasSubstr("intrinsic_matrix must be a list of 9 numbers"));
  EXPECT_THAT(json(replaced(open3d, "532.58", "\"wide\"")),
              HasSubstr("a.json: intrinsic_matrix: must be a number, is string"));
  EXPECT_THAT(json(replaced(open3d, "640", "6.5")), HasSubstr("the image is 6.5x480"));
}

TEST(Undistorted, APlaneSeenThroughALensIsAPlaneAgain) {
  // The depth of a tilted plane as a distorted camera measures it: pixel (u, v) looks along the ray whose distorted
  // image it is.
  Intrinsics intrinsics{.fx = 300,
                        .fy = 300,
                        .cx = 159.5,
                        .cy = 119.5,
                        .resolution = std::nullopt,
                        .distortion = {-0.25, 0.08, 0.001, -0.001, 0}};
  const RangeCamera camera = pinhole_camera(intrinsics, {320, 240});
  const auto plane_depth = [](double x, double y) { return static_cast<float>(2 / (1 + 0.3 * x + 0.2 * y)); };
  RangeImage seen{camera, std::vector<float>(320 * 240)};
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const double xd = (u - 159.5) / 300, yd = (v - 119.5) / 300;
      double x = xd, y = yd;
      for (int i = 0; i < 50; ++i) {  // invert the lens by fixed-point iteration
        const double r2 = x * x + y * y, radial = 1 - 0.25 * r2 + 0.08 * r2 * r2;
        const double dx = 2 * 0.001 * x * y - 0.001 * (r2 + 2 * x * x),
                     dy = 0.001 * (r2 + 2 * y * y) - 2 * 0.001 * x * y;
        x = (xd - dx) / radial;
        y = (yd - dy) / radial;
      }
      seen.depth[static_cast<std::size_t>(v * 320 + u)] = plane_depth(x, y);
    }
  }
  const RangeImage corrected = undistorted(seen, intrinsics);
  const RayGrid rays = camera.rays();
  int compared = 0;
  double worst_before = 0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (!RangeImage::is_hit(corrected.at(u, v))) continue;
      const double expected = static_cast<double>(plane_depth(rays.x(u), rays.y(v)));
      // The nearest pixel is at most half a pixel away on each axis, 1.35 times that without the lens (at the corners),
      // and the depth z of this plane changes by z^2/2 (0.3 dx + 0.2 dy).
      const double tolerance = 0.5 * expected * expected * (0.3 + 0.2) * 1.35 * 0.5 / 300;
      ASSERT_NEAR(static_cast<double>(corrected.at(u, v)), expected, tolerance);
      worst_before = std::max(worst_before, std::abs(static_cast<double>(seen.at(u, v)) - expected));
      ++compared;
    }
  }
  EXPECT_GT(compared, 70'000);
  EXPECT_GT(worst_before, 0.01) << "there was something to correct";
  intrinsics.distortion = {0, 0, 0};
  EXPECT_EQ(undistorted(seen, intrinsics).depth, seen.depth);
}

TEST(CameraFile, DamagedFilesAreReadOrRefused) {
  const auto damage = [](const std::string& bytes, auto parse) {
    const FuzzCount count =
        read_damaged(bytes, 2000, [&](const std::string& damaged) { ASSERT_GT(parse(damaged, "a").fx, 0); });
    EXPECT_EQ(count.accepted + count.refused, 2000);
    EXPECT_GT(count.refused, 300);
  };
  damage(text_matrix, parse_intrinsics_text);
  damage(calibration, parse_intrinsics_yaml);
  damage(open3d, parse_intrinsics_json);
}

TEST(CameraFile, LongYamlIsRefusedBeforeItIsParsed) {
  std::string bytes = "a: [";
  while (bytes.size() < 300000) bytes += "x,";
  EXPECT_THAT(input_error_of([&] { (void)parse_intrinsics_yaml(bytes + "]", "a.yaml"); }),
              testing::HasSubstr("a.yaml: has 300001 bytes; YAML must have at most 262144"));
}

}  // namespace
}  // namespace vantage
