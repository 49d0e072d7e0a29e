#include "depth_input.hpp"

#include "bindings.hpp"
#include "options.hpp"
#include "vantage/recordings/scan_bytes.hpp"

namespace vantage::python {
namespace {

template <class Pixel>
std::vector<Pixel> values_of(const py::array& array) {
  const auto packed = py::array_t<Pixel, py::array::c_style | py::array::forcecast>::ensure(array);
  return std::vector<Pixel>(packed.data(), packed.data() + packed.size());
}

DepthPixels pixels_of(const py::array& depth) {
  require_shape(depth, {-1, -1}, "depth (rows, columns)");
  require(depth.size() > 0, "depth: has no pixels");
  const Resolution resolution{static_cast<int>(depth.shape(1)), static_cast<int>(depth.shape(0))};
  if (depth.dtype().kind() == 'f') return FloatImage{resolution, values_of<float>(depth)};
  // Whole numbers of another type may be anything: better to ask than to guess.
  require(depth.dtype().kind() == 'u' && depth.dtype().itemsize() == 2, "depth: has the type ",
          std::string(py::str(depth.dtype())),
          "; must be uint16, in units of depth_scale, or floating-point numbers in `unit`");
  return Gray16{resolution, values_of<std::uint16_t>(depth)};
}

std::pair<ScanHolder, View> scan_from_depth(const py::array& depth, const DoubleArray& intrinsics, const Pose& pose,
                                            const std::vector<double>& distortion, const std::optional<py::array>& mask,
                                            const py::kwargs& keywords) {
  ScanFolderOptions options;
  set_options(option_fields(options), keywords, "scan_from_depth");
  auto [scan, view] = read_depth({depth, intrinsics, distortion, mask}, pose, options);
  return {ScanHolder{std::move(scan)}, view};
}

}  // namespace

std::pair<Scan, View> read_depth(const DepthInput& input, const Pose& reported, const ScanFolderOptions& options) {
  options.validate();
  const DepthPixels pixels = pixels_of(without_masked(input.depth, RangeImage::unknown));
  require_shape(input.intrinsics, {3, 3}, "intrinsics");
  Intrinsics intrinsics = intrinsics_of(
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(input.intrinsics.data()), "intrinsics");
  intrinsics.distortion = input.distortion;
  std::optional<Mask> mask;
  if (input.mask) {
    require_shape(*input.mask, {input.depth.shape(0), input.depth.shape(1)}, "mask");
    mask.emplace();
    for (const bool counts : values_of<bool>(without_masked(*input.mask, 0))) mask->push_back(counts ? 1 : 0);
  }
  const py::gil_scoped_release release;
  const View view{sensor_pose(reported, hand_eye_offset(options), options)};
  return {scan_of_depth(pixels, intrinsics, mask, view, options), view};
}

void bind_depth_input(py::module_& module) {
  ScanFolderOptions options;
  const std::string help =
      "A Scan and the pose (4, 4) of its sensor from arrays as a driver and a robot give them.\n\ndepth: (rows, "
      "columns), "
      "uint16 in units of depth_scale, or floating-point numbers in `unit` (infinite: nothing there; 0, negative or "
      "NaN: "
      "unknown). intrinsics: (3, 3), pixels. pose: (4, 4), world from sensor, or from the robot's hand with hand_eye; "
      "its "
      "position in `unit`. distortion: k1 k2 p1 p2 k3 k4 k5 k6, or fewer. mask: (rows, columns), zero where a pixel "
      "does not "
      "count.\nOptions by keyword, as on the command line:\n\n" +
      options_text(option_fields(options));
  module.def("scan_from_depth", &scan_from_depth, py::arg("depth"), py::arg("intrinsics"), py::arg("pose"),
             py::arg("distortion") = std::vector<double>(), py::arg("mask") = py::none(), help.c_str());
}

}  // namespace vantage::python
