#include "bindings.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage::python {

/// An array of uint16 as it came: pybind11's own array_t loses what numpy.ma has masked in it.
struct UnitsArray {
  py::array array;
};

}  // namespace vantage::python

template <>
struct pybind11::detail::type_caster<vantage::python::UnitsArray> {
  PYBIND11_TYPE_CASTER(vantage::python::UnitsArray, handle_type_name<array_t<std::uint16_t>>::name);
  bool load(handle source, bool) {
    if (!array_t<std::uint16_t>::check_(source)) return false;
    value.array = reinterpret_borrow<array>(source);
    return true;
  }
};

namespace vantage::python {
namespace {

RangeCamera with_limits(RangeCamera camera, double min_depth, double max_depth, std::optional<double> max_incidence) {
  camera.min_depth = min_depth;
  camera.max_depth = max_depth;
  camera.max_incidence = max_incidence;
  camera.validate();
  return camera;
}

void require_fits(const py::array& pixels, const RangeCamera& camera) {
  require_shape(pixels, {camera.resolution.rows, camera.resolution.columns}, "depth (rows, columns of the camera)");
}

RangeImage image_from_metres(const RangeCamera& camera, const py::array& given) {
  camera.validate();
  const py::array metres = without_masked(given, RangeImage::unknown);
  require_fits(metres, camera);
  // Whole numbers of another type are likely millimetres: better to ask than to guess.
  require(metres.dtype().kind() == 'f', "depth: is of type ", std::string(py::str(metres.dtype())),
          "; must be floating-point numbers in metres, or uint16 with a depth_scale");
  const FloatArray depth(metres);
  RangeImage image{camera, {depth.data(), depth.data() + depth.size()}};
  image.validate();
  return image;
}

RangeImage image_from_units(const RangeCamera& camera, const UnitsArray& given, double depth_scale,
                            std::optional<std::uint16_t> no_return) {
  camera.validate();
  const py::array pixels = without_masked(given.array, RangeImage::unknown);
  require_fits(pixels, camera);
  const auto packed = py::array_t<std::uint16_t, py::array::c_style>::ensure(pixels);
  const Gray16 grey{camera.resolution, {packed.data(), packed.data() + packed.size()}};
  const DepthEncoding encoding{.metres_per_unit = depth_scale, .no_return = no_return};
  encoding.validate();
  return range_image(grey, camera, encoding);
}

/// The depths where they lie; the array keeps the image alive.
py::array_t<float> depth_view(py::object self) {
  auto& image = self.cast<RangeImage&>();
  return py::array_t<float>({image.camera.resolution.rows, image.camera.resolution.columns}, image.depth.data(), self);
}

void bind_camera(py::module_& module) {
  const auto min_depth = py::arg("min_depth") = 0.0;
  const auto max_depth = py::arg("max_depth") = 4.5;
  const auto max_incidence = py::arg("max_incidence") = py::none();
  py::class_<RangeCamera>(
      module, "RangeCamera",
      "A pinhole depth camera: its field of view, its pixels and its depth limits. Sensor axes: x "
      "right, y down, z forward; depths are along z. Build one with from_apertures, from_intrinsics "
      "or from_text.")
      .def_static(
          "from_apertures",
          [](double horizontal, double vertical, Resolution resolution, double near, double far,
             std::optional<double> incidence) {
            return with_limits(camera_from_apertures(horizontal, vertical, resolution), near, far, incidence);
          },
          py::arg("horizontal"), py::arg("vertical"), py::arg("resolution"), min_depth, max_depth, max_incidence,
          "A symmetric camera from its full apertures in radians and its resolution (columns, rows). Depth limits in "
          "metres; max_incidence is the largest angle between a surface's normal and the way to the sensor, radians.")
      .def_static(
          "from_intrinsics",
          [](double fx, double fy, double cx, double cy, Resolution resolution, double near, double far,
             std::optional<double> incidence) {
            return with_limits(camera_from_intrinsics(fx, fy, cx, cy, resolution), near, far, incidence);
          },
          py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"), py::arg("resolution"), min_depth, max_depth,
          max_incidence,
          "A camera from pinhole intrinsics in pixels; pixel centres lie at whole numbers. resolution = (columns, "
          "rows).")
      .def_static("from_text", &camera_from_text, py::arg("text"),
                  "A camera as on the command line: 'HxV:COLUMNSxROWS', apertures in degrees, e.g. '45x45:320x320'.")
      .def_readonly("resolution", &RangeCamera::resolution, "(columns, rows) in pixels.")
      .def_readwrite("min_depth", &RangeCamera::min_depth, "Nearest depth, metres.")
      .def_readwrite("max_depth", &RangeCamera::max_depth, "Farthest depth, metres.")
      .def_readwrite("max_incidence", &RangeCamera::max_incidence, "Radians, or None for no limit.")
      .def_property_readonly("horizontal_aperture", &RangeCamera::horizontal_aperture, "Full aperture, radians.")
      .def_property_readonly("vertical_aperture", &RangeCamera::vertical_aperture, "Full aperture, radians.")
      .def("ideal_resolution", &ideal_resolution, py::arg("voxel_length"), py::arg("distance"),
           "Eq. 14 of the paper: (columns, rows) at which neighbouring rays are one voxel apart at `distance` metres.")
      .def("__repr__", [](const RangeCamera& camera) {
        return concat("<vantage.RangeCamera ", degrees(camera.horizontal_aperture()), "x",
                      degrees(camera.vertical_aperture()), " degrees, ", camera.resolution.columns, "x",
                      camera.resolution.rows, ", ", camera.min_depth, "..", camera.max_depth, " m>");
      });
}

}  // namespace

void bind_sensor(py::module_& module) {
  module.def("look_at", &look_at, py::arg("position"), py::arg("target"),
             "The 4x4 pose (world from sensor, metres) of a sensor at `position` that looks at `target`; up is +z.");
  bind_camera(module);
  py::class_<RangeImage>(module, "RangeImage",
                         "Depth along the viewing axis per pixel, metres. 0 is unknown, infinity means that nothing is "
                         "there up to the camera's far limit.")
      // uint16 first: numpy would turn whole numbers into metres without asking.
      .def(py::init(&image_from_units), py::arg("camera"), py::arg("depth").noconvert(), py::kw_only(),
           py::arg("depth_scale") = 0.001, py::arg("no_return") = py::none(),
           "From raw pixels, uint16 (rows, columns), copied; depth_scale is metres per unit. Nearer than the camera's "
           "min_depth is unknown, farther than max_depth is no return; no_return is the value that says so.")
      .def(py::init(&image_from_metres), py::arg("camera"), py::arg("depth"),
           "From metres, float32 (rows, columns), copied.")
      .def_readonly("camera", &RangeImage::camera)
      .def_property_readonly("depth", &depth_view, "float32 (rows, columns), metres: a view of the image, no copy.")
      .def(
          "normals",
          [](const RangeImage& image) {
            std::vector<Vec3f> normals;
            {
              const py::gil_scoped_release release;
              normals = range_image_normals(image);
            }
            return array_of<float>(std::move(normals),
                                   {image.camera.resolution.rows, image.camera.resolution.columns, 3});
          },
          "Unit normals in the sensor frame, facing the sensor: float32 (rows, columns, 3); zero where there is none.");
}

}  // namespace vantage::python
