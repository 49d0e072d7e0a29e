#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "vantage/files/text_reader.hpp"
#include "vantage/files/yaml_text.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/camera_parts.hpp"

namespace vantage {
namespace {

using namespace camera_parts;

/// The first of the keys that the map has; no node otherwise.
YAML::Node first_of(const YAML::Node& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const YAML::Node node = map[key]; node.IsDefined()) return node;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

/// Numbers as a list, as a list of lists, or as the list `data` in a map, which is how OpenCV and ROS write matrices.
std::vector<double> yaml_numbers(YAML::Node node, std::string_view what, const std::string& name) {
  constexpr std::size_t most = 64;
  require(node.IsDefined(), name, ": has no '", what, "'");
  if (node.IsMap() && node["data"].IsDefined()) node.reset(node["data"]);
  require(node.IsSequence(), place_of(node, name), ": ", what, " must be a list of numbers");
  std::vector<double> numbers;
  for (const YAML::Node& item : node) {
    if (item.IsSequence()) {
      for (const YAML::Node& inner : item) numbers.push_back(yaml_number(inner, what, name));
    } else {
      numbers.push_back(yaml_number(item, what, name));
    }
    require(numbers.size() <= most, place_of(node, name), ": ", what, " has more than ", most, " numbers");
  }
  return numbers;
}

std::string text_of(const YAML::Node& node, const char* otherwise) {
  return node.IsDefined() && node.IsScalar() ? node.Scalar() : otherwise;
}

/// A camera of Kalibr's camchain.
Intrinsics kalibr_camera(const YAML::Node& camera, const std::string& name) {
  const std::string model = text_of(camera["camera_model"], "pinhole");
  require(model == "pinhole", place_of(camera, name), ": camera_model ", in_quotes(model), ": must be pinhole");
  const std::vector<double> k = yaml_numbers(camera["intrinsics"], "intrinsics", name);
  require(k.size() == 4, place_of(camera["intrinsics"], name), ": intrinsics has ", k.size(),
          " numbers, must be 4 (fu fv pu pv)");
  Intrinsics intrinsics{.fx = k[0], .fy = k[1], .cx = k[2], .cy = k[3], .resolution = std::nullopt, .distortion = {}};
  if (const YAML::Node size = camera["resolution"]; size.IsDefined()) {
    const std::vector<double> sides = yaml_numbers(size, "resolution", name);
    require(sides.size() == 2, place_of(size, name), ": resolution has ", sides.size(), " numbers, must be 2");
    intrinsics.resolution = resolution_of(sides[0], sides[1], name);
  }
  const YAML::Node coefficients = first_of(camera, {"distortion_coeffs", "distortion_coefficients"});
  if (coefficients.IsDefined()) {
    set_distortion(intrinsics, text_of(camera["distortion_model"], "radtan"),
                   yaml_numbers(coefficients, "distortion_coeffs", name), place_of(coefficients, name));
  }
  return checked(intrinsics, name);
}

/// ROS's camera_info and what OpenCV's programs write.
Intrinsics matrix_camera(const YAML::Node& info, const std::string& name) {
  const YAML::Node node = first_of(info, {"camera_matrix", "K", "k", "Camera_Matrix", "cameraMatrix", "CameraMatrix",
                                          "camera_intrinsics", "M1", "intrinsic_matrix", "mtx"});
  require(node.IsDefined(), name,
          ": has no 'camera_matrix' (ROS or OpenCV calibration), 'K' (message) or 'cam0' (Kalibr)");
  Intrinsics intrinsics = from_rows(yaml_numbers(node, "camera_matrix", name), place_of(node, name));
  const YAML::Node width = first_of(info, {"image_width", "width", "image_Width", "imageWidth"});
  const YAML::Node height = first_of(info, {"image_height", "height", "image_Height", "imageHeight"});
  if (width.IsDefined() && height.IsDefined()) {
    intrinsics.resolution =
        resolution_of(yaml_number(width, "image_width", name), yaml_number(height, "image_height", name), name);
  }
  const YAML::Node coefficients = first_of(info, {"distortion_coefficients", "D", "d", "Distortion_Coefficients",
                                                  "distCoeffs", "dist_coeffs", "D1", "dist"});
  const YAML::Node model = first_of(info, {"distortion_model", "camera_model"});
  const bool is_fisheye = text_of(first_of(info, {"fisheye_model", "fisheye"}), "0") == "1";
  const std::string model_name = is_fisheye ? "fisheye" : text_of(model, "plumb_bob");
  std::vector<double> numbers;
  if (coefficients.IsDefined()) numbers = yaml_numbers(coefficients, "distortion_coefficients", name);
  set_distortion(intrinsics, model_name == "pinhole" || model_name.empty() ? "plumb_bob" : model_name,
                 std::move(numbers), coefficients.IsDefined() ? place_of(coefficients, name) : name);
  return checked(intrinsics, name);
}

/// The text without the first line of OpenCV's files, `%YAML:1.0`, which is no YAML; the line stays, empty.
std::string without_opencv_head(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  std::string text(bytes);
  if (bytes.substr(0, 6) == "%YAML:") text.erase(0, std::min(text.find('\n'), text.size()));
  return text;
}

}  // namespace

Intrinsics parse_intrinsics_yaml(std::string_view bytes, const std::string& name) {
  const YAML::Node info = parse_yaml(without_opencv_head(bytes), name);
  require(info.IsMap(), name, ": is not a ROS camera_info file (must be a map with 'camera_matrix' or 'K')");
  if (const YAML::Node camera = info["cam0"]; camera.IsDefined() && camera.IsMap()) {
    require(!info["cam1"].IsDefined(), name,
            ": has several cameras (cam0, cam1 ...); must have the depth camera's alone");
    return kalibr_camera(camera, name);
  }
  if (info["intrinsics"].IsDefined() && info["camera_model"].IsDefined()) return kalibr_camera(info, name);
  return matrix_camera(info, name);
}

}  // namespace vantage
