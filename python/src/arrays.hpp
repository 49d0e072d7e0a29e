#pragma once

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/core/geometry.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/view.hpp"

// How the library's small types look in Python: poses and views are 4x4 arrays, resolutions pairs, boxes 2x3 arrays.
// Every file of the module includes this one, so that all convert alike.
namespace vantage::python {

namespace py = pybind11;

using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast>;
using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// The shape of an array as text, for errors.
[[nodiscard]] std::string shape_text(const py::array& array);
/// The array without what numpy.ma has masked in it: those elements become `filled`. Other arrays as they are; they
/// would lose their mask, and hidden values count, when they are converted.
[[nodiscard]] py::array without_masked(const py::array& array, double filled);
/// Throws InputError unless the array has this shape; -1 stands for any length.
void require_shape(const py::array& array, std::initializer_list<py::ssize_t> shape, const std::string& what);

/// An array of the given shape that takes over the values; nothing is copied.
template <class Scalar, class Value>
[[nodiscard]] py::array_t<Scalar> array_of(std::vector<Value> values, std::vector<py::ssize_t> shape) {
  auto owned = std::make_unique<std::vector<Value>>(std::move(values));
  const auto* data = reinterpret_cast<const Scalar*>(owned->data());
  const py::capsule owner(owned.get(), [](void* pointer) { delete static_cast<std::vector<Value>*>(pointer); });
  owned.release();
  return py::array_t<Scalar>(std::move(shape), data, owner);
}

/// N vectors of length 3 as an (N, 3) array, without a copy.
template <class Vector>
[[nodiscard]] auto rows_of(std::vector<Vector> values) {
  static_assert(sizeof(Vector) == 3 * sizeof(typename Vector::Scalar));
  const auto count = static_cast<py::ssize_t>(values.size());
  return array_of<typename Vector::Scalar>(std::move(values), {count, 3});
}

/// The rows of an (N, 3) array as vectors; a copy. Throws InputError for another shape.
[[nodiscard]] std::vector<Vec3> points_from(const DoubleArray& array, const std::string& what);

/// The normals in an array (..., 3) of `count` vectors, where they lie. The array must outlive the span.
[[nodiscard]] std::span<const Vec3f> normals_in(const FloatArray& array, std::size_t count);

}  // namespace vantage::python

namespace pybind11::detail {

template <>
struct type_caster<vantage::Pose> {
  PYBIND11_TYPE_CASTER(vantage::Pose, const_name("numpy.ndarray[numpy.float64[4, 4]]"));
  bool load(handle source, bool) {
    const auto array = vantage::python::DoubleArray::ensure(source);
    if (!array) return false;
    vantage::python::require_shape(array, {4, 4}, "pose");
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data());
    value = vantage::rigid_pose(matrix, "pose");
    return true;
  }
  static handle cast(const vantage::Pose& pose, return_value_policy, handle) {
    array_t<double> array({4, 4});
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) = pose.matrix();
    return array.release();
  }
};

template <>
struct type_caster<vantage::View> {
  PYBIND11_TYPE_CASTER(vantage::View, const_name("numpy.ndarray[numpy.float64[4, 4]]"));
  bool load(handle source, bool convert) {
    type_caster<vantage::Pose> pose;
    if (!pose.load(source, convert)) return false;
    value.world_from_sensor = pose;
    return true;
  }
  static handle cast(const vantage::View& view, return_value_policy policy, handle parent) {
    return type_caster<vantage::Pose>::cast(view.world_from_sensor, policy, parent);
  }
};

template <>
struct type_caster<vantage::Resolution> {
  PYBIND11_TYPE_CASTER(vantage::Resolution, const_name("Tuple[int, int]"));
  bool load(handle source, bool convert) {
    type_caster<std::pair<int, int>> pair;
    if (!pair.load(source, convert)) return false;
    const auto [columns, rows] = static_cast<std::pair<int, int>>(pair);
    value = {columns, rows};
    return true;
  }
  static handle cast(const vantage::Resolution& resolution, return_value_policy, handle) {
    return make_tuple(resolution.columns, resolution.rows).release();
  }
};

template <>
struct type_caster<vantage::Box3> {
  PYBIND11_TYPE_CASTER(vantage::Box3, const_name("numpy.ndarray[numpy.float64[2, 3]]"));
  bool load(handle source, bool) {
    const auto array = vantage::python::DoubleArray::ensure(source);
    if (!array) return false;
    vantage::python::require_shape(array, {2, 3}, "box (its least and its greatest corner)");
    value = vantage::Box3(vantage::Vec3(array.data()), vantage::Vec3(array.data() + 3));
    return true;
  }
  static handle cast(const vantage::Box3& box, return_value_policy, handle) {
    array_t<double> array({2, 3});
    Eigen::Map<vantage::Vec3>(array.mutable_data()) = box.min();
    Eigen::Map<vantage::Vec3>(array.mutable_data() + 3) = box.max();
    return array.release();
  }
};

}  // namespace pybind11::detail
