#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "vantage/files/json_text.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/camera_parts.hpp"

namespace vantage {
namespace {

using namespace camera_parts;
using nlohmann::json;

/// The first of the keys that the object has; null otherwise.
const json* first_of(const json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const auto found = object.find(key); found != object.end()) return &*found;
  }
  return nullptr;
}

std::optional<double> number_of(const json& object, std::initializer_list<const char*> keys, const std::string& name) {
  const json* found = first_of(object, keys);
  if (found == nullptr) return std::nullopt;
  return json_number(*found, name + ": " + *keys.begin());
}

/// Numbers of a list, or of a list of lists.
std::vector<double> json_numbers(const json& list, const std::string& what) {
  constexpr std::size_t most = 64;
  require(list.is_array(), what, ": must be a list of numbers");
  std::vector<double> numbers;
  for (const json& item : list) {
    if (item.is_array()) {
      for (const json& inner : item) numbers.push_back(json_number(inner, what));
    } else {
      numbers.push_back(json_number(item, what));
    }
    require(numbers.size() <= most, what, ": has more than ", most, " numbers");
  }
  return numbers;
}

std::string text_of(const json* value, const char* otherwise) {
  return value != nullptr && value->is_string() ? value->get<std::string>() : otherwise;
}

void read_size(const json& object, Intrinsics& intrinsics, const std::string& name) {
  const auto width = number_of(object, {"width", "w", "image_width", "SensorWidth"}, name);
  const auto height = number_of(object, {"height", "h", "image_height", "SensorHeight"}, name);
  if (width && height) intrinsics.resolution = resolution_of(*width, *height, name);
}

/// Coefficients as a list, or each by its name.
void read_lens(const json& object, Intrinsics& intrinsics, const std::string& name) {
  std::vector<double> coefficients;
  if (const json* list = first_of(object, {"coeffs", "dist_coeffs", "distortion_coefficients", "distortion", "D"});
      list != nullptr && list->is_array()) {
    coefficients = json_numbers(*list, name + ": distortion");
  } else {
    for (const char* key : {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"})
      coefficients.push_back(number_of(object, {key}, name).value_or(0));
  }
  std::string model = text_of(first_of(object, {"model", "distortion_model", "camera_model"}), "plumb_bob");
  // librealsense's names, of which the inverse one is of images that are rectified as good as.
  if (const std::size_t dot = model.rfind('.'); dot != std::string::npos) model = model.substr(dot + 1);
  if (model == "PINHOLE" || model == "pinhole" || model == "none" || model == "None") model = "plumb_bob";
  if (model == "inverse_brown_conrady" || model == "Inverse Brown Conrady") model = "inverse_brown_conrady";
  if (model == "Brown Conrady" || model == "modified_brown_conrady") model = "brown_conrady";
  set_distortion(intrinsics, model, std::move(coefficients), name);
}

/// fx, fy and the principal point by themselves: RealSense (ppx), BOP's camera.json, exports of Azure Kinect,
/// nerfstudio.
std::optional<Intrinsics> flat_camera(const json& object, const std::string& name) {
  const auto fx = number_of(object, {"fx", "fl_x", "focal_x"}, name),
             fy = number_of(object, {"fy", "fl_y", "focal_y"}, name);
  const auto cx = number_of(object, {"cx", "ppx", "principal_x"}, name);
  const auto cy = number_of(object, {"cy", "ppy", "principal_y"}, name);
  if (!fx || !fy || !cx || !cy) return std::nullopt;
  Intrinsics intrinsics{.fx = *fx, .fy = *fy, .cx = *cx, .cy = *cy, .resolution = std::nullopt, .distortion = {}};
  read_size(object, intrinsics, name);
  read_lens(object, intrinsics, name);
  return checked(intrinsics, name);
}

std::optional<Intrinsics> matrix_camera(const json& object, const std::string& name) {
  const json* open3d = first_of(object, {"intrinsic_matrix"});
  const json* rows = first_of(object, {"camera_matrix", "cam_K", "K", "k", "intrinsics", "intrinsic", "mtx"});
  if (open3d == nullptr && (rows == nullptr || !rows->is_array())) return std::nullopt;
  Intrinsics intrinsics;
  if (open3d != nullptr) {
    const std::vector<double> columns = json_numbers(*open3d, name + ": intrinsic_matrix");
    require(columns.size() == 9, name, ": intrinsic_matrix must be a list of 9 numbers");
    std::vector<double> by_rows(9);
    for (std::size_t i = 0; i < 9; ++i) by_rows[3 * (i % 3) + i / 3] = columns[i];  // Open3D writes column by column
    intrinsics = from_rows(by_rows, name);
  } else {
    intrinsics = from_rows(json_numbers(*rows, name + ": camera_matrix"), name);
  }
  read_size(object, intrinsics, name);
  read_lens(object, intrinsics, name);
  return checked(intrinsics, name);
}

/// The depth camera in the calibration that an Azure Kinect holds. Its numbers are shares of the sensor's 1024x1024
/// pixels, of which the images of the usual mode (NFOV unbinned) are the 640x576 from column 192 and row 180 on.
std::optional<Intrinsics> azure_camera(const json& object, const std::string& name) {
  const json* information = first_of(object, {"CalibrationInformation"});
  const json* cameras =
      information == nullptr || !information->is_object() ? nullptr : first_of(*information, {"Cameras"});
  if (cameras == nullptr || !cameras->is_array()) return std::nullopt;
  for (const json& camera : *cameras) {
    if (!camera.is_object() || text_of(first_of(camera, {"Purpose"}), "").find("Depth") == std::string::npos) continue;
    const json* lens = first_of(camera, {"Intrinsics"});
    require(lens != nullptr && lens->is_object() && lens->contains("ModelParameters"), name,
            ": the depth camera has no 'ModelParameters'");
    const std::vector<double> p = json_numbers((*lens)["ModelParameters"], name + ": ModelParameters");
    require(p.size() >= 14, name, ": ModelParameters has ", p.size(), " numbers, must be 14");
    constexpr double sensor = 1024;
    Intrinsics intrinsics{.fx = p[2] * sensor,
                          .fy = p[3] * sensor,
                          .cx = p[0] * sensor - 0.5 - 192,
                          .cy = p[1] * sensor - 0.5 - 180,
                          .resolution = Resolution{640, 576},
                          .distortion = {}};
    set_distortion(intrinsics, "rational_polynomial", {p[4], p[5], p[13], p[12], p[6], p[7], p[8], p[9]}, name);
    return checked(intrinsics, name);
  }
  throw InputError(name + ": has no depth camera among 'Cameras'");
}

}  // namespace

Intrinsics parse_intrinsics_json(std::string_view bytes, const std::string& name) {
  const json object = parse_json(bytes, name);
  require(object.is_object(), name, ": is not a camera (must be an object with 'intrinsic_matrix' or fx, fy, cx, cy)");
  if (const auto camera = azure_camera(object, name)) return *camera;
  if (const auto camera = matrix_camera(object, name)) return *camera;
  if (const auto camera = flat_camera(object, name)) return *camera;
  for (const char* key : {"depth", "depth_camera", "depth_intrinsics", "intrinsics", "camera"}) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_object()) continue;
    if (const auto camera = matrix_camera(*found, name)) return *camera;
    if (const auto camera = flat_camera(*found, name)) return *camera;
  }
  throw InputError(name +
                   ": is not an Open3D camera (must be an object with 'intrinsic_matrix'), nor has it fx, fy, cx "
                   "and cy (ppx and ppy), 'cam_K' or 'camera_matrix'");
}

}  // namespace vantage
