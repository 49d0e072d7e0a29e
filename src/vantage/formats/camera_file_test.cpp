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
              HasSubstr("a.xml: intrinsics must be a .txt (3x3, 4x4, COLMAP, KITTI), .yaml"));
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

TEST(CameraFile, TextMayBeAMatrixOfFourAlone) {
  expect_intrinsics(parse_intrinsics_text("532.58 0 316.04 0\n0 532.21 236.03 0\n0 0 1 0\n0 0 0 1\n", "a.txt"));
  expect_intrinsics(parse_intrinsics_text("532.58 0 316.04 0 532.21 236.03 0 0 1\n", "a.txt"));
  expect_intrinsics(parse_intrinsics_text("# fx fy cx cy\n532.58 532.21 316.04 236.03\n", "a.txt"));
  expect_intrinsics(
      parse_intrinsics_text("calib_time: 09-Jan-2012\nP0: 532.58 0 316.04 0 0 532.21 236.03 0 0 0 1 0\n", "calib.txt"));
}

TEST(CameraFile, OpenCvAndKalibrWriteYamlOfTheirOwn) {
  const Intrinsics opencv = parse_intrinsics_yaml(
      "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   "
      "dt: d\n   data: [ 532.58, 0., 316.04, 0.,\n       532.21, 236.03, 0., 0., 1. ]\ndistortion_coefficients: "
      "!!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ 1.0e-01, -2.0e-01, 0., 0., 5.0e-02 ]\n",
      "a.yml");
  expect_intrinsics(opencv);
  EXPECT_EQ(opencv.resolution, (Resolution{640, 480}));
  EXPECT_THAT(opencv.distortion, ElementsAre(0.1, -0.2, 0, 0, 0.05));
  const std::string kalibr =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]\n  distortion_model: equidistant\n  "
      "intrinsics: [532.58, 532.21, 316.04, 236.03]\n  resolution: [640, 480]\n  rostopic: /depth\n";
  const Intrinsics fisheye = parse_intrinsics_yaml(kalibr, "camchain.yaml");
  expect_intrinsics(fisheye);
  EXPECT_EQ(fisheye.lens, LensModel::equidistant);
  EXPECT_THAT(fisheye.distortion, ElementsAre(0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(parse_intrinsics_yaml(replaced(kalibr, "equidistant", "radtan"), "a").lens, LensModel::polynomial);
  EXPECT_THAT(input_error_of([&] { (void)parse_intrinsics_yaml(replaced(kalibr, "intrinsics", "intrinsic"), "a"); }),
              HasSubstr("a: has no 'intrinsics'"));
  EXPECT_THAT(input_error_of([&] { (void)parse_intrinsics_yaml(kalibr + "cam1: {}\n", "a.yaml"); }),
              HasSubstr("a.yaml: has several cameras (cam0, cam1 ...)"));
}

TEST(CameraFile, AnEquidistantCameraWithoutCoefficientsIsNoPinhole) {
  const Intrinsics k = parse_intrinsics_yaml(
      replaced(replaced(message, "plumb_bob", "equidistant"), "D: [0.0, 0.0, 0.0, 0.0, 0.0]", "D: [0, 0, 0, 0]"), "a");
  EXPECT_EQ(k.lens, LensModel::equidistant);
  EXPECT_TRUE(k.is_distorted());
}

TEST(CameraFile, SensorsAndDataSetsWriteJsonOfTheirOwn) {
  const Intrinsics realsense = parse_intrinsics_json(
      R"({"width": 640, "height": 480, "ppx": 316.04, "ppy": 236.03, "fx": 532.58, "fy": 532.21,
          "model": "distortion.inverse_brown_conrady", "coeffs": [0.0, 0.0, 0.0, 0.0, 0.0]})",
      "a.json");
  expect_intrinsics(realsense);
  EXPECT_EQ(realsense.resolution, (Resolution{640, 480}));
  EXPECT_FALSE(realsense.is_distorted());
  expect_intrinsics(parse_intrinsics_json(
      R"({"cx": 316.04, "cy": 236.03, "depth_scale": 0.1, "fx": 532.58, "fy": 532.21, "height": 480, "width": 640})",
      "a"));
  expect_intrinsics(parse_intrinsics_json(R"({"cam_K": [532.58, 0, 316.04, 0, 532.21, 236.03, 0, 0, 1]})", "a"));
  expect_intrinsics(parse_intrinsics_json(
      R"({"depth": {"fx": 532.58, "fy": 532.21, "cx": 316.04, "cy": 236.03}, "color": {"fx": 1}})", "a"));
  const Intrinsics azure = parse_intrinsics_json(
      R"({"CalibrationInformation": {"Cameras": [{"Purpose": "CALIBRATION_CameraPurposeDepth", "Intrinsics":
          {"ModelParameters": [0.5, 0.5, 0.49, 0.491, 1, 2, 3, 4, 5, 6, 0, 0, 0.002, 0.001],
           "ModelType": "CALIBRATION_LensDistortionModelBrownConrady"}, "SensorWidth": 1024, "SensorHeight": 1024}]}})",
      "a");
  EXPECT_EQ(azure.resolution, (Resolution{640, 576}));
  EXPECT_NEAR(azure.fx, 0.49 * 1024, 1e-9);
  EXPECT_NEAR(azure.cx, 512 - 0.5 - 192, 1e-9);
  EXPECT_NEAR(azure.cy, 512 - 0.5 - 180, 1e-9);
  EXPECT_THAT(azure.distortion, ElementsAre(1, 2, 0.001, 0.002, 3, 4, 5, 6));
}

TEST(CameraFile, ColmapCountsPixelsFromTheirCorners) {
  const Intrinsics k =
      parse_intrinsics_text("# Camera list\n1 OPENCV 640 480 532.58 532.21 316.54 236.53 0.1 -0.2 0.001 0\n", "a.txt");
  EXPECT_NEAR(k.cx, 316.04, 1e-9);
  EXPECT_NEAR(k.cy, 236.03, 1e-9);
  EXPECT_THAT(k.distortion, ElementsAre(0.1, -0.2, 0.001, 0));
  const Intrinsics simple = parse_intrinsics_text("7 SIMPLE_RADIAL_FISHEYE 640 480 500 320 240 0.1\n", "a.txt");
  EXPECT_EQ(simple.fy, 500);
  EXPECT_EQ(simple.lens, LensModel::equidistant);
  EXPECT_THAT(input_error_of([] { (void)parse_intrinsics_text("1 FOV 640 480 500 500 320 240 1\n", "a.txt"); }),
              HasSubstr("a.txt, line 1: camera model 'FOV' is not known"));
}

TEST(CameraFile, SwappedSizesAreNamed) {
  EXPECT_THAT(input_error_of([] {
                (void)pinhole_camera(parse_intrinsics_yaml(calibration, "a"), {480, 640});
              }),
              HasSubstr("the intrinsics are for 640x480 pixels, the image has 480x640; width and height are swapped"));
}

TEST(CameraFile, BadTextIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) {
    return input_error_of([&] { (void)parse_intrinsics_text(bytes, "a.txt"); });
  };
  EXPECT_THAT(error(""),
              HasSubstr("a.txt: has 0 rows of 0 numbers, must be 3 rows of 3 numbers (fx 0 cx, 0 fy cy, 0 0 1)"));
  EXPECT_THAT(error("500 0\n"), HasSubstr("a.txt: has 1 rows of 2 numbers, must be 3 rows of 3 numbers"));
  EXPECT_EQ(error("500 0 320\n0 500\n"), "a.txt, line 2: number 3 of row 2 is missing");
  EXPECT_THAT(error("500 0 320\n0 500 240 1\n"), HasSubstr("a.txt, line 2: row 2 has 4 numbers, must be 3 rows of 3"));
  EXPECT_THAT(error(text_matrix + "0 0 1\n"), HasSubstr("a.txt: has 4 rows of 3 numbers"));
  EXPECT_THAT(error("500 0 320 0\n0 500 240 0\n0 0 1 0\n0 0 2 1\n"),
              HasSubstr("row 4, column 3 of the 4x4 camera matrix is 2, must be 0"));
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
  EXPECT_THAT(
      yaml("a: 1"),
      HasSubstr("a.yaml: has no 'camera_matrix' (ROS or OpenCV calibration), 'K' (message) or 'cam0' (Kalibr)"));
  EXPECT_THAT(yaml("K: 5"), HasSubstr("a.yaml, line 1: camera_matrix must be a list of numbers"));
  EXPECT_THAT(yaml("K: [1, 2]"), HasSubstr("the camera matrix has 2 numbers, must be 9 (3x3) or 16 (4x4)"));
  EXPECT_THAT(yaml(replaced(message, "532.58", "wide")),
              HasSubstr("a.yaml, line 6: camera_matrix = 'wide': must be a finite number"));
  EXPECT_THAT(yaml(replaced(message, "width: 640", "width: 0")),
              HasSubstr("the image is 0x480: both must be whole numbers within 1"));
  EXPECT_THAT(yaml(replaced(message, "width: 640", "width: 310")),
              HasSubstr("principal point (316.04, 236.03) lies outside the 310x480 image"));
  EXPECT_THAT(yaml(replaced(calibration, "plumb_bob", "omni")),
              HasSubstr("distortion_model 'omni': must be plumb_bob, rational_polynomial or equidistant"));
  EXPECT_THAT(yaml(replaced(calibration, "plumb_bob", "equidistant")),
              HasSubstr("has 5 coefficients of an equidistant lens, must be at most 4"));
  EXPECT_THAT(yaml(replaced(calibration, "data: [0.1,", "data: [1,2,3,4,5,6,7,8,9,10,11,")),
              HasSubstr("has 15 distortion coefficients, must be at most 14"));
  const auto json = [](const std::string& bytes) {
    return input_error_of([&] { (void)parse_intrinsics_json(bytes, "a.json"); });
  };
  EXPECT_THAT(json("{}"),
              HasSubstr("a.json: is not an Open3D camera (must be an object with 'intrinsic_matrix'), nor has it fx"));
  EXPECT_THAT(json(R"({"intrinsic_matrix": [1, 2]})"), HasSubstr("intrinsic_matrix must be a list of 9 numbers"));
  EXPECT_THAT(json(replaced(open3d, "532.58", "\"wide\"")),
              HasSubstr("a.json: intrinsic_matrix: must be a number, is string"));
  EXPECT_THAT(json(replaced(open3d, "640", "6.5")), HasSubstr("the image is 6.5x480"));
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
