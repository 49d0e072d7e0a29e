#include "arrays.hpp"

namespace vantage::python {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  return text + ")";
}

py::array without_masked(const py::array& array, double filled) {
  if (!py::isinstance(array, py::module_::import("numpy").attr("ma").attr("MaskedArray"))) return array;
  return array.attr("filled")(filled).cast<py::array>();
}

void require_shape(const py::array& array, std::initializer_list<py::ssize_t> shape, const std::string& what) {
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  std::string wanted;
  py::ssize_t axis = 0;
  for (const py::ssize_t length : shape) {
    fits = fits && (length < 0 || array.shape(axis) == length);
    wanted += (axis++ == 0 ? "" : ", ") + (length < 0 ? "N" : std::to_string(length));
  }
  require(fits, what, ": has the shape ", shape_text(array), "; must be (", wanted, ")");
}

std::vector<Vec3> points_from(const DoubleArray& array, const std::string& what) {
  require_shape(array, {-1, 3}, what);
  const auto* first = reinterpret_cast<const Vec3*>(array.data());
  return {first, first + array.shape(0)};
}

std::span<const Vec3f> normals_in(const FloatArray& array, std::size_t count) {
  require(array.ndim() > 0 && array.shape(array.ndim() - 1) == 3 && static_cast<std::size_t>(array.size()) == 3 * count,
          "normals: have the shape ", shape_text(array), "; must be three numbers for each of the ", count, " pixels");
  return {reinterpret_cast<const Vec3f*>(array.data()), count};
}

}  // namespace vantage::python
