#include "vantage/formats/camera_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/files/yaml_text.hpp"

namespace vantage {
namespace {

constexpr int longest_side = 16384;
constexpr std::size_t most_coefficients = 8;

Resolution resolution_of(double width, double height, const std::string& name) {
  for (const double side : {width, height}) {
    require(side >= 1 && side <= longest_side && side == std::floor(side), name, ": the image is ", width, "x", height,
            ": both must be whole numbers within 1 and ", longest_side);
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

Intrinsics checked(Intrinsics intrinsics, const std::string& name) {
  try {
    intrinsics.validate();
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
  return intrinsics;
}

/// The first of the keys that the map has; no node otherwise.
YAML::Node first_of(const YAML::Node& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const YAML::Node node = map[key]; node.IsDefined()) return node;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

/// Numbers as a list, or as the list `data` in a map, which is how OpenCV and ROS write matrices.
std::vector<double> yaml_numbers(YAML::Node node, std::string_view what, const std::string& name) {
  if (node.IsMap() && node["data"].IsDefined()) node.reset(node["data"]);
  require(node.IsSequence(), place_of(node, name), ": ", what, " must be a list of numbers");
  std::vector<double> numbers;
  for (const YAML::Node& item : node) numbers.push_back(yaml_number(item, what, name));
  return numbers;
}

Intrinsics from_matrix(const std::array<double, 9>& row_by_row, const std::string& name) {
  return intrinsics_of(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_by_row.data()), name);
}

std::vector<double> read_distortion(const YAML::Node& info, const std::string& name) {
  const YAML::Node node = first_of(info, {"distortion_coefficients", "D", "d"});
  if (!node.IsDefined()) return {};
  std::vector<double> coefficients = yaml_numbers(node, "distortion_coefficients", name);
  if (std::all_of(coefficients.begin(), coefficients.end(), [](double c) { return c == 0; })) return {};
  const YAML::Node model = info["distortion_model"];
  const std::string text = model.IsDefined() && model.IsScalar() ? model.Scalar() : "plumb_bob";
  require(text == "plumb_bob" || text == "rational_polynomial", place_of(node, name), ": distortion_model ",
          in_quotes(text), ": must be plumb_bob or rational_polynomial; rectify the images first");
  require(coefficients.size() <= most_coefficients, place_of(node, name), ": has ", coefficients.size(),
          " distortion coefficients, must be at most ", most_coefficients);
  return coefficients;
}

struct Point2 {
  double x, y;
};

/// Where the lens puts a point of the image plane (coordinates over depth): OpenCV's model, which ROS uses.
Point2 distorted(const std::array<double, most_coefficients>& c, double x, double y) {
  const auto [k1, k2, p1, p2, k3, k4, k5, k6] = c;
  const double r2 = x * x + y * y;
  const double radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

}  // namespace

void Intrinsics::validate() const {
  require(std::isfinite(fx) && std::isfinite(fy) && fx > 0 && fy > 0, "fx = ", fx, ", fy = ", fy,
          ": focal lengths must be positive (pixels)");
  require(std::isfinite(cx) && std::isfinite(cy), "cx = ", cx, ", cy = ", cy, ": must be finite numbers (pixels)");
  require(distortion.size() <= most_coefficients, "distortion: ", distortion.size(), " coefficients, must be at most ",
          most_coefficients);
  for (const double coefficient : distortion) {
    require(std::isfinite(coefficient), "distortion: ", coefficient, ": must be finite numbers");
  }
  if (resolution) (void)camera_from_intrinsics(fx, fy, cx, cy, *resolution);
}

Intrinsics intrinsics_of(const Mat3& k, const std::string& name) {
  require(k(2, 0) == 0 && k(2, 1) == 0 && k(2, 2) == 1, name, ": the last row of the camera matrix is ", k(2, 0), " ",
          k(2, 1), " ", k(2, 2), ", must be 0 0 1 (is the matrix transposed?)");
  require(k(0, 1) == 0 && k(1, 0) == 0, name, ": the camera matrix has a skew (", k(0, 1), ", ", k(1, 0),
          "), must be 0");
  return {.fx = k(0, 0), .fy = k(1, 1), .cx = k(0, 2), .cy = k(1, 2), .resolution = std::nullopt, .distortion = {}};
}

bool Intrinsics::is_distorted() const {
  return std::any_of(distortion.begin(), distortion.end(), [](double c) { return c != 0; });
}

Intrinsics parse_intrinsics_text(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  std::array<double, 9> matrix{};
  for (std::size_t row = 0; row < 3; ++row) {
    if (!text.next_line_with_words()) {
      throw InputError(
          fmt::format("{}: has {} rows, must be 3 rows of 3 numbers (fx 0 cx, 0 fy cy, 0 0 1)", name, row));
    }
    for (std::size_t column = 0; column < 3; ++column) {
      matrix[3 * row + column] = text.finite_number(fmt::format("number {} of row {}", column + 1, row + 1));
    }
    if (!text.at_end_of_line())
      text.fail(fmt::format("{} is a fourth number, must be 3 per row", in_quotes(text.word())));
  }
  if (text.next_line_with_words()) text.fail("a fourth row, must be 3 rows of 3 numbers");
  return checked(from_matrix(matrix, name), name);
}

Intrinsics parse_intrinsics_yaml(std::string_view bytes, const std::string& name) {
  const YAML::Node info = parse_yaml(bytes, name);
  require(info.IsMap(), name, ": is not a ROS camera_info file (must be a map with 'camera_matrix' or 'K')");
  const YAML::Node node = first_of(info, {"camera_matrix", "K", "k"});
  require(node.IsDefined(), name, ": has no 'camera_matrix' (calibration file) or 'K' (message)");
  const std::vector<double> numbers = yaml_numbers(node, "camera_matrix", name);
  require(numbers.size() == 9, place_of(node, name), ": camera_matrix has ", numbers.size(), " numbers, must be 9");
  std::array<double, 9> matrix{};
  std::copy(numbers.begin(), numbers.end(), matrix.begin());
  Intrinsics intrinsics = from_matrix(matrix, name);
  const YAML::Node width = first_of(info, {"image_width", "width"});
  const YAML::Node height = first_of(info, {"image_height", "height"});
  if (width.IsDefined() && height.IsDefined()) {
    intrinsics.resolution =
        resolution_of(yaml_number(width, "image_width", name), yaml_number(height, "image_height", name), name);
  }
  intrinsics.distortion = read_distortion(info, name);
  return checked(intrinsics, name);
}

Intrinsics parse_intrinsics_json(std::string_view bytes, const std::string& name) {
  const nlohmann::json object = parse_json(bytes, name);
  require(object.is_object() && object.contains("intrinsic_matrix"), name,
          ": is not an Open3D camera (must be an object with 'intrinsic_matrix')");
  const nlohmann::json& list = object["intrinsic_matrix"];
  require(list.is_array() && list.size() == 9, name, ": intrinsic_matrix must be a list of 9 numbers");
  std::array<double, 9> matrix{};
  for (std::size_t i = 0; i < 9; ++i) {
    matrix[3 * (i % 3) + i / 3] = json_number(list[i], name + ": intrinsic_matrix");  // Open3D writes column by column
  }
  Intrinsics intrinsics = from_matrix(matrix, name);
  if (object.contains("width") && object.contains("height")) {
    intrinsics.resolution = resolution_of(json_number(object["width"], name + ": width"),
                                          json_number(object["height"], name + ": height"), name);
  }
  return checked(intrinsics, name);
}

Intrinsics read_intrinsics(const std::filesystem::path& path) {
  const auto ending = path.extension();
  const bool is_known = ending == ".txt" || ending == ".yaml" || ending == ".yml" || ending == ".json";
  require(is_known, path.string(), ": intrinsics must be a .txt (3x3), .yaml (ROS) or .json (Open3D) file");
  const std::string bytes = read_file(path);
  if (ending == ".txt") return parse_intrinsics_text(bytes, path.string());
  if (ending == ".json") return parse_intrinsics_json(bytes, path.string());
  return parse_intrinsics_yaml(bytes, path.string());
}

RangeCamera pinhole_camera(const Intrinsics& intrinsics, Resolution resolution) {
  intrinsics.validate();
  if (intrinsics.resolution && !(*intrinsics.resolution == resolution)) {
    throw InputError(fmt::format("the intrinsics are for {}x{} pixels, the image has {}x{}",
                                 intrinsics.resolution->columns, intrinsics.resolution->rows, resolution.columns,
                                 resolution.rows));
  }
  return camera_from_intrinsics(intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy, resolution);
}

RangeImage undistorted(RangeImage image, const Intrinsics& intrinsics) {
  if (!intrinsics.is_distorted()) return image;
  intrinsics.validate();
  std::array<double, most_coefficients> coefficients{};
  std::copy(intrinsics.distortion.begin(), intrinsics.distortion.end(), coefficients.begin());
  const auto [columns, rows] = image.camera.resolution;
  RangeImage result{image.camera, std::vector<float>(image.depth.size(), RangeImage::unknown)};
  std::size_t pixel = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++pixel) {
      const auto [x, y] =
          distorted(coefficients, (column - intrinsics.cx) / intrinsics.fx, (row - intrinsics.cy) / intrinsics.fy);
      const double u = std::round(intrinsics.fx * x + intrinsics.cx);
      const double v = std::round(intrinsics.fy * y + intrinsics.cy);
      if (u >= 0 && u < columns && v >= 0 && v < rows)
        result.depth[pixel] = image.at(static_cast<int>(u), static_cast<int>(v));
    }
  }
  return result;
}

}  // namespace vantage
