#include <set>

#include "bindings.hpp"
#include "options.hpp"
#include "utility.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/simulate.hpp"

namespace vantage::python {
namespace {

using OnScan = std::function<void(const ScanRecord&, const VoxelMap&)>;

/// A built-in object by its name, or any mesh; with the size that it has by default.
std::pair<TriangleMesh, double> object_of(const std::variant<std::string, TriangleMesh>& object) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&object)) return {*mesh, 0.815};
  const std::string& name = std::get<std::string>(object);
  return {make_object(name), default_size(name)};
}

SimulatedRun run_simulation(const std::variant<std::string, TriangleMesh>& object, const std::optional<OnScan>& on_scan,
                            const AnyUtility& utility, const py::kwargs& keywords) {
  ReconstructOptions options;
  std::set<std::string> given;
  set_options(noting(option_fields(options), given), keywords, "simulate");
  options.utility = name_of(utility).value_or(options.utility);
  given.insert("utility");
  const std::optional<Utility> function = utility_of(utility);
  const py::gil_scoped_release release;
  load_robot(options, given);
  options.validate();
  const auto [mesh, size] = object_of(object);
  RunObserver observer;
  // Control-C arrives between two scans.
  observer.interrupted = [] {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return false;
  };
  if (on_scan) {
    observer.on_scan = [&](const ScanRecord& record, const Scan&, const ObjectModel& model, const Plan*) {
      (*on_scan)(record, model.map);
    };
  }
  return simulate(SimulatedObject(mesh, options.size.value_or(size), options), options, observer, function);
}

std::string simulate_help() {
  ReconstructOptions options;
  return "A whole reconstruction in simulation: a SimulatedRun.\n\nobject: the name of a built-in object "
         "(object_names) "
         "or a TriangleMesh. on_scan(record, map): called after every scan with its record and a copy of the map. "
         "utility: as for Planner.\n"
         "Options by keyword, as on the command line; the same options give the same bits:\n\n" +
         options_text(option_fields(options));
}

void bind_meshes(py::module_& module) {
  py::class_<TriangleMesh>(module, "TriangleMesh", "A surface as triangles, counter-clockwise seen from outside.")
      .def(py::init([](const DoubleArray& vertices,
                       const py::array_t<int, py::array::c_style | py::array::forcecast>& triangles) {
             require_shape(triangles, {-1, 3}, "triangles");
             TriangleMesh mesh{points_from(vertices, "vertices"), {}};
             const auto* first = reinterpret_cast<const Index3*>(triangles.data());
             mesh.triangles.assign(first, first + triangles.shape(0));
             check_mesh(mesh, "mesh");
             return mesh;
           }),
           py::arg("vertices"), py::arg("triangles"), "vertices (n, 3) metres, triangles (m, 3) indices; copied.")
      .def_static("read", &read_mesh, py::arg("path"), "From a PLY, OBJ, STL or OFF file.")
      .def(
          "write", [](const TriangleMesh& mesh, const std::filesystem::path& path) { write_mesh_ply(path, mesh); },
          py::arg("path"), "As binary PLY.")
      .def_property_readonly(
          "vertices", [](const TriangleMesh& mesh) { return rows_of(mesh.vertices); },
          "float64 (n, 3), metres; a copy.")
      .def_property_readonly(
          "triangles", [](const TriangleMesh& mesh) { return rows_of(mesh.triangles); }, "int32 (m, 3); a copy.");
  module.def("object_names", &object_names, "Names of the built-in objects.");
  module.def("make_object", &make_object, py::arg("name"), "A built-in object at its default size, a TriangleMesh.");
}

void bind_records(py::module_& module) {
  py::class_<ScanRecord>(module, "ScanRecord", "One scan of a reconstruction: where from, why, and what it brought.")
      .def_readonly("scan", &ScanRecord::scan, "From 0.")
      .def_readonly("candidate", &ScanRecord::candidate, "-1: none of the candidates.")
      .def_readonly("commanded", &ScanRecord::commanded, "(4, 4), world from sensor.")
      .def_readonly("believed", &ScanRecord::believed, "(4, 4), world from sensor.")
      .def_readonly("registered", &ScanRecord::registered, "(4, 4), world from sensor.")
      .def_readonly("planned", &ScanRecord::planned, "The Evaluation that led here, or None.")
      .def_readonly("reason", &ScanRecord::reason)
      .def_readonly("new_occupied", &ScanRecord::new_occupied, "Voxels.")
      .def_readonly("mean_quality", &ScanRecord::mean_quality)
      .def_readonly("distance", &ScanRecord::distance, "Travelled so far, metres.")
      .def_readonly("coverage", &ScanRecord::coverage, "Of the visible surface, 0 to 1; None where not simulated.")
      .def_readonly("coverage_all", &ScanRecord::coverage_all, "Of the whole surface.")
      .def_readonly("merged", &ScanRecord::merged, "False where registration failed.")
      .def_readonly("merged_after", &ScanRecord::merged_after, "The scan after which it came into the map, or None.")
      .def_readonly("true_view", &ScanRecord::true_view, "(4, 4), world from sensor; None where not simulated.")
      .def_readonly("pose_error", &ScanRecord::pose_error,
                    "Mean distance of its points from where they should be, metres; None where not simulated.")
      .def_readonly("overlap", &ScanRecord::overlap)
      .def_readonly("residual", &ScanRecord::residual, "Metres.")
      .def_readonly("verdict", &ScanRecord::verdict)
      .def_property_readonly(
          "labels",
          [](const ScanRecord& record) {
            const LabelCounts& n = record.labels;
            py::dict counts;
            counts["unmarked"] = n.unmarked;
            counts["occupied"] = n.occupied;
            counts["empty"] = n.empty;
            counts["occluded"] = n.occluded;
            counts["occplane"] = n.occplane;
            return counts;
          },
          "Voxels of the enclosure by label after the scan.")
      .def("__repr__", [](const ScanRecord& record) {
        return concat("<vantage.ScanRecord ", record.scan, " from view ", record.candidate, ", ", record.verdict, ", ",
                      record.new_occupied, " new voxels>");
      });
  py::class_<SimulatedRun>(module, "SimulatedRun", "What a reconstruction in simulation came to.")
      .def_property_readonly(
          "map", [](SimulatedRun& run) -> VoxelMap& { return run.model.map; },
          py::return_value_policy::reference_internal)
      .def_property_readonly(
          "scans", [](const SimulatedRun& run) { return run.model.scans; }, "List of ScanRecord.")
      .def(
          "cloud", [](const SimulatedRun& run) { return run.model.surface.cloud(); }, "The fused PointCloud; a copy.")
      .def_readonly("stop_reason", &SimulatedRun::stop_reason);
}

}  // namespace

void bind_simulation(py::module_& module) {
  bind_meshes(module);
  bind_records(module);
  using Release = py::call_guard<py::gil_scoped_release>;
  py::class_<RangeScanner>(module, "RangeScanner", "A noise-free range camera in front of a triangle mesh.")
      .def(py::init<TriangleMesh>(), py::arg("mesh"))
      .def("scan", &RangeScanner::scan, py::arg("camera"), py::arg("view"), Release(),
           "The RangeImage that the camera takes from a view (4x4, world from sensor).")
      .def("distance", &RangeScanner::distance, py::arg("point"), "From a point (3,) to the surface, metres.");
  py::class_<SimulatedRobot>(module, "SimulatedRobot",
                             "A free flyer with a range camera that may err: it believes to be where it was sent.")
      .def(py::init([](const RangeScanner& scanner, const RangeCamera& camera, const Vec3& positioning_error,
                       const std::vector<double>& depth_noise, const std::string& sensor, std::uint64_t seed) {
             require(depth_noise.size() == 2 || depth_noise.size() == 3, "depth_noise has ", depth_noise.size(),
                     " numbers; must have 2 or 3");
             ReconstructOptions options;
             options.positioning_error = positioning_error;
             options.depth_noise = {depth_noise[0], depth_noise[1], depth_noise.size() == 3 ? depth_noise[2] : 0};
             options.sensor = sensor;
             options.registration = "icp";  // the first pose is exact
             options.validate();
             return std::make_unique<SimulatedRobot>(scanner, camera, simulated_robot_options(options), seed);
           }),
           py::arg("scanner"), py::arg("camera"), py::kw_only(), py::arg("positioning_error") = Vec3(Vec3::Zero()),
           py::arg("depth_noise") = std::vector<double>{0, 0}, py::arg("sensor") = "ideal", py::arg("seed") = 1,
           py::keep_alive<1, 2>(),
           "positioning_error (3,): standard deviation per axis, metres; depth_noise: A, B[, C] of A + B z^2 + C "
           "tan^2(incidence), instead of the deviation of the sensor, one of sensor_names, where it is not 0.")
      .def("move_to", &SimulatedRobot::move_to, py::arg("view"), Release(), "False where it cannot get there.")
      .def("take_range_image", &SimulatedRobot::take_range_image, Release())
      .def_property_readonly("view", &SimulatedRobot::view, "(4, 4), where the robot believes to be.")
      .def_property_readonly("true_view", &SimulatedRobot::true_view, "(4, 4), where it is.");
  const std::string help = simulate_help();
  module.def("simulate", &run_simulation, py::arg("object"), py::arg("on_scan") = py::none(),
             py::arg("utility") = "combined", help.c_str());
  module.def(
      "reconstruct_options",
      [] {
        ReconstructOptions options;
        return options_list(option_fields(options));
      },
      "The options of simulate(): a list of dicts with name, default, unit and meaning.");
}

}  // namespace vantage::python
