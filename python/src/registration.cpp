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
  py::class_<Options>(module, "RegistrationOptions", "How scans are registered; None means: by the sensor's noise.")
      .def(py::init(&options_from), "Attributes by keyword, e.g. RegistrationOptions(starts=48).")
      .def_readwrite("starts", &Options::starts, "Poses drawn from what is believed that the search begins at.")
      .def_readwrite("outlier_share", &Options::outlier_share,
                     "Share of what the sensor measures that may be wrong by more than its noise.")
      .def_readwrite("largest_misplacement", &Options::largest_misplacement,
                     "How far surfaces may be put off by what remains unknown of the pose, metres.")
      .def_readwrite("ambiguity", &Options::ambiguity, "Largest probability that another pose is the right one.");
}

/// The model with the deviation of the sensor that its scans come from.
struct PythonSurface {
  ModelSurface surface;
  std::optional<SensorModel> sensor;

  PythonSurface(double spacing, const std::optional<std::pair<double, double>>& depth_noise) : surface(spacing) {
    if (!depth_noise) return;
    sensor = SensorModel{.constant = depth_noise->first, .quadratic = depth_noise->second};
    sensor->validate();
  }

  [[nodiscard]] ScanSurface of(const ScanHolder& holder) const {
    if (const auto* image = std::get_if<ImageScan>(&holder.scan)) return scan_surface(image->image, sensor);
    const auto& lines = std::get<PointScan>(holder.scan);
    return lines.origins.empty() ? of(points_of(holder.scan))
                                 : scan_surface(points_of(holder.scan), lines.origins, sensor);
  }
  [[nodiscard]] ScanSurface of(const PointCloud& cloud) const {
    const Vec3 origin = Vec3::Zero();
    return scan_surface(cloud, {&origin, 1}, sensor);
  }
  void merge(const PointCloud& cloud, const ScanSurface& scan, const Pose& pose) {
    surface.merge(cloud, pose);
    surface.merge(scan, pose);
  }
};

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
      .def_readonly("covariance", &Registration::covariance,
                    "(6, 6): of the position (world axes, metres) and the rotation vector (world axes, radians).")
      .def_readonly("misplacement", &Registration::misplacement,
                    "Metres: standard deviation of 95 % of the scan's surface along its normals.")
      .def_readonly("undetermined_directions", &Registration::undetermined_directions)
      .def_readonly("explanation", &Registration::explanation, "One sentence for people.")
      .def_property_readonly("succeeded", &Registration::succeeded)
      .def("__repr__", [](const Registration& r) {
        return concat("<vantage.Registration ", name(r.verdict), ", overlap ", r.overlap, ", residual ", r.residual,
                      " m>");
      });
  using Noise = std::optional<std::pair<double, double>>;
  py::class_<PythonSurface>(module, "ModelSurface", "All merged scans, to register the next scan against.")
      .def(py::init<double, const Noise&>(), py::arg("spacing"), py::arg("depth_noise") = py::none(),
           "spacing: distance between the points of cloud(), metres. depth_noise: (A, B), the standard deviation of a "
           "depth z is A + B z^2 metres.")
      .def(
          "merge",
          [](PythonSurface& model, const ScanHolder& scan, const Pose& pose) {
            const py::gil_scoped_release release;
            model.merge(cloud_of(scan), model.of(scan), pose);
          },
          py::arg("scan"), py::arg("world_from_sensor"), "Adds a Scan whose pose (4x4) is known.")
      .def(
          "merge",
          [](PythonSurface& model, const PointCloud& cloud, const Pose& pose) {
            model.merge(cloud, model.of(cloud), pose);
          },
          py::arg("cloud"), py::arg("world_from_sensor"), "Adds a PointCloud in the sensor frame.")
      .def(
          "cloud", [](const PythonSurface& model) { return model.surface.cloud(); },
          "The fused PointCloud, world frame; a copy.");
  using Release = py::call_guard<py::gil_scoped_release>;
  const auto def = [&](auto example, const char* text) {
    using Scanned = decltype(example);
    module.def(
        "register_scan",
        [](const PythonSurface& model, const Scanned& scan, const Pose& believed, double pose_error,
           double pose_angle_error, const RegistrationOptions& options) {
          return register_scan(model.surface.registered(), model.of(scan),
                               PoseEstimate::around(believed, pose_error / 3, radians(pose_angle_error) / 3), options);
        },
        py::arg("model"), py::arg("scan"), py::arg("believed"), py::arg("pose_error") = 0.05,
        py::arg("pose_angle_error") = 5, py::arg("options") = RegistrationOptions(), Release(), text);
  };
  def(ScanHolder(),
      "Finds the pose of a Scan against the model: the most probable one, by the believed pose (4x4, world from "
      "sensor), "
      "which is off by at most pose_error metres and pose_angle_error degrees about each axis (three standard "
      "deviations), and by how the surfaces fit.");
  def(PointCloud(), "The same for a PointCloud in the sensor frame.");
}

}  // namespace vantage::python
