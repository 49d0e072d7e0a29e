#include "vantage/formats/camera_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/camera_parts.hpp"

namespace vantage {

void Intrinsics::validate() const {
  require(std::isfinite(fx) && std::isfinite(fy) && fx > 0 && fy > 0, "fx = ", fx, ", fy = ", fy,
          ": focal lengths must be positive (pixels)");
  require(std::isfinite(cx) && std::isfinite(cy), "cx = ", cx, ", cy = ", cy, ": must be finite numbers (pixels)");
  const std::size_t most =
      lens == LensModel::equidistant ? camera_parts::most_equidistant : camera_parts::most_polynomial;
  require(distortion.size() <= most, "distortion: ", distortion.size(), " coefficients, must be at most ", most);
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
  return lens == LensModel::equidistant ||
         std::any_of(distortion.begin(), distortion.end(), [](double c) { return c != 0; });
}

Intrinsics read_intrinsics(const std::filesystem::path& path) {
  const auto ending = path.extension();
  const bool is_known = ending == ".txt" || ending == ".yaml" || ending == ".yml" || ending == ".json";
  require(
      is_known, path.string(),
      ": intrinsics must be a .txt (3x3, 4x4, COLMAP, KITTI), .yaml (ROS, OpenCV, Kalibr) or .json (Open3D, RealSense, "
      "Azure Kinect, BOP) file");
  const std::string bytes = read_file(path);
  if (ending == ".txt") return parse_intrinsics_text(bytes, path.string());
  if (ending == ".json") return parse_intrinsics_json(bytes, path.string());
  return parse_intrinsics_yaml(bytes, path.string());
}

RangeCamera pinhole_camera(const Intrinsics& intrinsics, Resolution resolution) {
  intrinsics.validate();
  if (intrinsics.resolution && !(*intrinsics.resolution == resolution)) {
    const Resolution expected = *intrinsics.resolution;
    const bool is_swapped = expected == Resolution{resolution.rows, resolution.columns};
    throw ResolutionError(fmt::format("the intrinsics are for {}x{} pixels, the image has {}x{}{}", expected.columns,
                                      expected.rows, resolution.columns, resolution.rows,
                                      is_swapped ? "; width and height are swapped" : ""));
  }
  return camera_from_intrinsics(intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy, resolution);
}

}  // namespace vantage
