#include "vantage/registration/registration.hpp"
#include "bindings.hpp"

namespace vantage::python {
namespace {

/// Sets the members that the keywords name.
RegistrationOptions options_from(const py::kwargs& keywords) {
  py::object options = py::cast(RegistrationOptions());
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    require(py::hasattr(options, name.c_str()), "registration: unknown option '", name,
            "'; the attributes of RegistrationOptions are the options");
    options.attr(name.c_str()) = value;
  }
  const auto result = options.cast<RegistrationOptions>();
  result.validate();
  return result;
}

void bind_options(py::module_& module) {
  using Options = RegistrationOptions;
  py::class_<Options>(module, "RegistrationOptions", "How scans are registered; None means: measured from the data.")
      .def(py::init(&options_from), "Attributes by keyword, e.g. RegistrationOptions(search_radius=0.05).")
      .def_readwrite("spacing", &Options::spacing, "Distance between neighbouring points of a scan, metres.")
      .def_readwrite("search_radius", &Options::search_radius,
                     "How far points may be from where the believed pose puts them, metres.")
      .def_readwrite("finest_cell_in_spacings", &Options::finest_cell_in_spacings)
      .def_readwrite("max_iterations", &Options::max_iterations, "Per level of resolution.")
      .def_readwrite("least_overlap", &Options::least_overlap, "Share of the scan that must lie on the model.")
      .def_readwrite("largest_residual_in_cells", &Options::largest_residual_in_cells)
      .def_readwrite("least_resistance", &Options::least_resistance)
      .def_readwrite("orientation_error", &Options::orientation_error,
                     "Standard deviation of the believed orientation, radians.")
      .def_readwrite("largest_open_misfit", &Options::largest_open_misfit, "Metres.")
      .def_readwrite("trust", &Options::trust, "In the believed pose; 0: the surfaces alone decide.")
      .def_readwrite("largest_share_in_free_space", &Options::largest_share_in_free_space)
      .def_readwrite("ambiguity", &Options::ambiguity);
}

PointCloud cloud_of(const ScanHolder& holder) { return points_of(holder.scan); }

}  // namespace

void bind_registration(py::module_& module) {
  bind_options(module);
  py::class_<Registration>(module, "Registration", "What registration found. Merge only a scan that succeeded.")
      .def_readonly("world_from_sensor", &Registration::world_from_sensor, "(4, 4), metres.")
      .def_readonly("overlap", &Registration::overlap, "Share of the scan that lies on the model, 0 to 1.")
      .def_readonly("residual", &Registration::residual, "RMS distance of the overlap to the model, metres.")
      .def_property_readonly(
          "verdict", [](const Registration& r) { return std::string(name(r.verdict)); }, "'registered', or why not.")
      .def_readonly("undetermined_directions", &Registration::undetermined_directions)
      .def_readonly("explanation", &Registration::explanation, "One sentence for people.")
      .def_property_readonly("succeeded", &Registration::succeeded)
      .def("__repr__", [](const Registration& r) {
        return concat("<vantage.Registration ", name(r.verdict), ", overlap ", r.overlap, ", residual ", r.residual,
                      " m>");
      });
  py::class_<ModelSurface>(module, "ModelSurface", "All merged scans as one cloud, to register the next scan against.")
      .def(py::init<double>(), py::arg("spacing"), "spacing: distance between the kept points, metres.")
      .def(
          "merge",
          [](ModelSurface& model, const ScanHolder& scan, const Pose& pose) {
            const py::gil_scoped_release release;
            if (const auto* image = std::get_if<ImageScan>(&scan.scan)) {
              model.merge(cloud_of(scan), image->image, pose);
            } else {
              model.merge(cloud_of(scan), pose);
            }
          },
          py::arg("scan"), py::arg("world_from_sensor"), "Adds a Scan whose pose (4x4) is known.")
      .def(
          "merge", [](ModelSurface& model, const PointCloud& cloud, const Pose& pose) { model.merge(cloud, pose); },
          py::arg("cloud"), py::arg("world_from_sensor"), "Adds a PointCloud in the sensor frame.")
      .def(
          "cloud", [](const ModelSurface& model) { return model.cloud(); },
          "The fused PointCloud, world frame; a copy.");
  using Release = py::call_guard<py::gil_scoped_release>;
  module.def(
      "register_scan",
      [](const ModelSurface& model, const ScanHolder& scan, const Pose& believed, const RegistrationOptions& options) {
        const PointCloud cloud = cloud_of(scan);
        if (const auto* image = std::get_if<ImageScan>(&scan.scan)) {
          return register_scan(model, cloud, image->image, believed, options);
        }
        return register_scan(model, cloud, believed, options);
      },
      py::arg("model"), py::arg("scan"), py::arg("believed"), py::arg("options") = RegistrationOptions(), Release(),
      "Finds the pose of a Scan against the model, from the believed pose (4x4, world from sensor): point-to-plane "
      "ICP.");
  module.def(
      "register_scan",
      [](const ModelSurface& model, const PointCloud& cloud, const Pose& believed, const RegistrationOptions& options) {
        return register_scan(model, cloud, believed, options);
      },
      py::arg("model"), py::arg("cloud"), py::arg("believed"), py::arg("options") = RegistrationOptions(), Release(),
      "The same for a PointCloud in the sensor frame.");
}

}  // namespace vantage::python
