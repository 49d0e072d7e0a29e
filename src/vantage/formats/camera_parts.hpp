#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/formats/camera_file.hpp"

// What the readers of camera files share.
namespace vantage::camera_parts {

/// The most coefficients of each model.
inline constexpr std::size_t most_polynomial = 14, most_equidistant = 4;

/// Throws InputError with `name` where these are no sizes of an image.
[[nodiscard]] Resolution resolution_of(double width, double height, const std::string& name);

/// The intrinsics after validate(), whose errors get `name` in front.
[[nodiscard]] Intrinsics checked(Intrinsics intrinsics, const std::string& name);

/// Intrinsics from a matrix of 9 (3x3) or 16 (4x4) numbers, row by row.
[[nodiscard]] Intrinsics from_rows(std::span<const double> numbers, const std::string& name);

/// Sets lens and distortion by the name that a calibration program gives the model: plumb_bob, radtan, brown_conrady,
/// rational_polynomial, opencv, equidistant, fisheye, kannala_brandt4, none ... Throws InputError for others, and for
/// more coefficients than the model has.
void set_distortion(Intrinsics& intrinsics, std::string_view model, std::vector<double> coefficients,
                    const std::string& name);

}  // namespace vantage::camera_parts
