#include "vantage/formats/camera_parts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "vantage/files/text_reader.hpp"

namespace vantage::camera_parts {
namespace {

constexpr int longest_side = 16384;
constexpr std::array polynomial_names{
    "plumb_bob",           "radtan",   "brown_conrady",     "brown",      "opencv",
    "rational_polynomial", "rational", "radial-tangential", "thin_prism", "polynomial"};
constexpr std::array equidistant_names{"equidistant",     "equi",           "fisheye",
                                       "kannala_brandt4", "kannala_brandt", "opencv_fisheye"};

template <class Names>
bool is_one_of(const std::string& name, const Names& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

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

Intrinsics from_rows(std::span<const double> numbers, const std::string& name) {
  require(numbers.size() == 9 || numbers.size() == 16, name, ": the camera matrix has ", numbers.size(),
          " numbers, must be 9 (3x3) or 16 (4x4)");
  const std::size_t side = numbers.size() == 9 ? 3 : 4;
  Mat3 matrix;
  for (std::size_t i = 0; i < side * side; ++i) {
    const std::size_t row = i / side, column = i % side;
    if (row < 3 && column < 3) {
      matrix(static_cast<int>(row), static_cast<int>(column)) = numbers[i];
    } else {
      require(numbers[i] == (row == column ? 1 : 0), name, ": row ", row + 1, ", column ", column + 1,
              " of the 4x4 camera matrix is ", numbers[i], ", must be ", row == column ? 1 : 0);
    }
  }
  return intrinsics_of(matrix, name);
}

void set_distortion(Intrinsics& intrinsics, std::string_view model, std::vector<double> coefficients,
                    const std::string& name) {
  std::string known(model);
  std::transform(known.begin(), known.end(), known.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool all_zero = std::all_of(coefficients.begin(), coefficients.end(), [](double c) { return c == 0; });
  if (is_one_of(known, equidistant_names)) {
    // Without coefficients it is no pinhole either.
    intrinsics.lens = LensModel::equidistant;
    require(coefficients.size() <= most_equidistant || all_zero, name, ": has ", coefficients.size(),
            " coefficients of an equidistant lens, must be at most ", most_equidistant);
    if (coefficients.size() > most_equidistant) coefficients.resize(most_equidistant);
  } else {
    if (all_zero) return;
    require(is_one_of(known, polynomial_names), name, ": distortion_model ", in_quotes(model),
            ": must be plumb_bob, rational_polynomial or equidistant; rectify the images first");
    require(coefficients.size() <= most_polynomial, name, ": has ", coefficients.size(),
            " distortion coefficients, must be at most ", most_polynomial);
  }
  intrinsics.distortion = std::move(coefficients);
}

}  // namespace vantage::camera_parts
