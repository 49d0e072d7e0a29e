#include "bindings.hpp"
#include "options.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage::python {
namespace {

ScanSet open_folder(const std::filesystem::path& path, const py::kwargs& keywords) {
  ScanFolderOptions options;
  set_options(option_fields(options), keywords, "open_scans");
  const py::gil_scoped_release release;
  return open_scans(path, options);
}

std::string open_help() {
  ScanFolderOptions options;
  return "Opens a folder of depth frames or clouds with poses, or a Stanford .conf: a ScanSet. Images and clouds are "
         "read "
         "on demand.\nOptions by keyword, as on the command line:\n\n" +
         options_text(option_fields(options));
}

}  // namespace

void bind_files(py::module_& module) {
  py::class_<ScanFile>(module, "ScanFile", "One scan of a set: where it was taken, as far as is believed.")
      .def_readonly("name", &ScanFile::name)
      .def_readonly("view", &ScanFile::view, "(4, 4), world from sensor, metres.")
      .def(
          "read", [](const ScanFile& file) { return ScanHolder{file.read()}; },
          py::call_guard<py::gil_scoped_release>(), "Opens the file: a Scan.")
      .def("__repr__", [](const ScanFile& file) { return "<vantage.ScanFile " + file.name + ">"; });
  py::class_<ScanSet>(module, "ScanSet", "The scans of a folder, by name.")
      .def_readonly("scans", &ScanSet::scans, "List of ScanFile.")
      .def_readonly("camera", &ScanSet::camera, "RangeCamera of depth images, or None.")
      .def("__len__", [](const ScanSet& set) { return set.scans.size(); });
  const std::string help = open_help();
  module.def("open_scans", &open_folder, py::arg("path"), help.c_str());
  module.def("read_pose", &read_pose, py::arg("path"), "A pose (4, 4), camera to world, from a .txt or .json file.");
  module.def("write_pose", &write_pose, py::arg("path"), py::arg("pose"), "Writes a pose (4, 4) as text.");
  module.def(
      "write_depth_png",
      [](const std::filesystem::path& path, const RangeImage& image, double depth_scale) {
        write_depth_png(path, image, {.metres_per_unit = depth_scale, .no_return = 65535});
      },
      py::arg("path"), py::arg("image"), py::arg("depth_scale") = 0.001,
      "Writes a RangeImage as 16-bit PNG; 65535 stands for no return.");
}

}  // namespace vantage::python
