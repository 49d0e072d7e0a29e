#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// How a lens bends rays: by OpenCV's polynomials of the tangent (plumb_bob, rational_polynomial), or by those of the
/// angle from the axis (equidistant, OpenCV's fisheye).
enum class LensModel { polynomial, equidistant };

/// Intrinsics in pixels; pixel centres lie at whole numbers.
struct Intrinsics {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  /// Of the images they belong to, where the file says so.
  std::optional<Resolution> resolution;
  /// Lens distortion in OpenCV's order: k1 k2 p1 p2 k3, k4 k5 k6, s1 s2 s3 s4 (thin prism), tx ty (tilt), or k1 k2 k3
  /// k4 of an equidistant lens; missing ones are 0.
  std::vector<double> distortion;
  LensModel lens = LensModel::polynomial;

  /// Throws InputError naming the field.
  void validate() const;
  [[nodiscard]] bool is_distorted() const;
};

/// Intrinsics that are for images of another size.
class ResolutionError : public InputError {
 public:
  using InputError::InputError;
};

/// Intrinsics from a camera matrix (fx 0 cx, 0 fy cy, 0 0 1). Throws InputError starting with `name` for another one;
/// the values themselves are checked by validate().
[[nodiscard]] Intrinsics intrinsics_of(const Mat3& matrix, const std::string& name);

/// Intrinsics by the ending of the name: `.txt` 3x3 numbers row by row; `.yaml` or `.yml` ROS camera_info (calibration
/// file or printed message); `.json` Open3D's PinholeCameraIntrinsic. Throws InputError naming the file, the field and
/// what would be right.
[[nodiscard]] Intrinsics read_intrinsics(const std::filesystem::path& path);
/// The same from memory; `name` is used in errors.
[[nodiscard]] Intrinsics parse_intrinsics_text(std::string_view bytes, const std::string& name);
[[nodiscard]] Intrinsics parse_intrinsics_yaml(std::string_view bytes, const std::string& name);
[[nodiscard]] Intrinsics parse_intrinsics_json(std::string_view bytes, const std::string& name);

/// The ideal pinhole camera with these intrinsics for images of this resolution. Throws ResolutionError where they
/// are for another resolution. Depth limits stay those of RangeCamera.
[[nodiscard]] RangeCamera pinhole_camera(const Intrinsics& intrinsics, Resolution resolution);

}  // namespace vantage
