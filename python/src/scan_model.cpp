#include "vantage/model/scan_model.hpp"

#include <mutex>

#include "bindings.hpp"
#include "options.hpp"
#include "vantage/options/scan_planning_options.hpp"

namespace vantage::python {
namespace {

ScanPlanningOptions options_from(const py::kwargs& keywords, const std::string& function) {
  ScanPlanningOptions options;
  set_options(option_fields(options), keywords, function);
  options.validate();
  return options;
}

using NextView = std::pair<std::optional<Plan>, std::string>;  // and why there is none

/// A model that grows scan by scan, with the planner that goes with it.
class GrowingModel {
 public:
  GrowingModel(const ScanPlanningOptions& options, const ScanScene& scene)
      : options_(options), scene_(scene), registrar_(make_registrar(options.scene, scene)), scans_(scene) {
    if (const auto learner = options.planning.learner_options()) scans_.learner.emplace(*learner);
  }

  ScanRecord add(const ScanOrigin& origin, const Scan& scan, const View& believed) {
    const std::lock_guard lock(mutex_);
    if (const auto* image = std::get_if<ImageScan>(&scan); image != nullptr && !camera_) camera_ = image->image.camera;
    planned_.reset();
    return scans_.add(origin, scan, believed, *registrar_);
  }

  /// Planned once for each scan.
  [[nodiscard]] NextView next() {
    const std::lock_guard lock(mutex_);
    if (!planned_) planned_ = plan();
    return *planned_;
  }

  [[nodiscard]] const ObjectModel& model() const { return scans_.model(); }
  [[nodiscard]] const View& current() const { return scans_.current(); }

 private:
  [[nodiscard]] NextView plan() const {
    require(!scans_.model().scans.empty(), "next_best_view: no scan has been added yet");
    ScanScene scene = scene_;
    // As for a folder of scans: the sensor's distance so far, where the options give none.
    if (!options_.scene.radius) scene.radius = scans_.sensor_distance();
    Planner planner = options_.planner(scene.candidates(options_.scene.views), camera_);
    tell_of_scans(planner, scans_.model().scans);
    if (scans_.learner) planner.believe(scans_.learner->prediction());
    std::optional<Plan> plan = planner.next_best_view(scans_.model().map, scans_.current());
    return {std::move(plan), planner.why_finished()};
  }

  std::mutex mutex_;  // Python's threads run while this merges and plans
  ScanPlanningOptions options_;
  ScanScene scene_;
  std::unique_ptr<Registrar> registrar_;
  ScanModel scans_;
  std::optional<RangeCamera> camera_;
  std::optional<NextView> planned_;  // on all scans so far
};

std::unique_ptr<GrowingModel> empty_model(const Box3& box, const py::kwargs& keywords) {
  const ScanPlanningOptions options = options_from(keywords, "ScanModel");
  require((box.sizes().array() > 0).all(), "box: the greatest corner must be beyond the least one");
  return std::make_unique<GrowingModel>(options, scene_in(box, options.scene));
}

std::unique_ptr<GrowingModel> model_of_folder(const std::filesystem::path& path,
                                              const std::optional<std::function<void(const ScanRecord&)>>& on_scan,
                                              const py::kwargs& keywords) {
  const ScanPlanningOptions options = options_from(keywords, "read_scans");
  options.validate_without_commands();
  const py::gil_scoped_release release;
  options.reading.require_poses();
  const ScanSet set = open_scans(path, options.reading);
  std::vector<PendingScan> pending;
  for (const ScanFile& file : set.scans) pending.push_back({file.name, file.view, file.read});
  pending = kept_for_second_reading(std::move(pending));
  auto model = std::make_unique<GrowingModel>(options, fit_scene(pending, options.scene));
  for (const PendingScan& each : pending) {
    const ScanRecord record = model->add({.name = each.name}, each.read(), each.believed);
    if (on_scan) (*on_scan)(record);
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return model;
}

std::string with_options(const std::string& text) {
  ScanPlanningOptions options;
  return text + "\nOptions by keyword, as on the command line of `vantage plan`:\n\n" +
         options_text(option_fields(options));
}

}  // namespace

void bind_scan_model(py::module_& module) {
  using Release = py::call_guard<py::gil_scoped_release>;
  const std::string help = with_options(
      "What real scans, merged one after the other, come to, and what to scan next; the same as `vantage "
      "plan`.\n\nbox: "
      "(2, 3), least and greatest corner of where the object is, metres.");
  py::class_<GrowingModel>(module, "ScanModel", help.c_str())
      .def(py::init(&empty_model), py::arg("box"), "See the class for the options.")
      .def(
          "add",
          [](GrowingModel& model, const ScanHolder& scan, const View& believed, const std::string& name,
             const std::optional<View>& commanded) {
            return model.add({.name = name, .commanded = commanded}, scan.scan, believed);
          },
          py::arg("scan"), py::arg("believed"), py::arg("name") = "", py::arg("commanded") = py::none(), Release(),
          "Registers a Scan from where the robot believes the sensor to be (4x4) and merges it where that succeeds: a "
          "ScanRecord. commanded: where the sensor was sent (4x4), from which believed_error='learn' learns.")
      .def(
          "next_best_view", [](GrowingModel& model) { return model.next().first; }, Release(),
          "The Plan for the next scan, or None where nothing is left to see.")
      .def_property_readonly(
          "why_finished",
          [](GrowingModel& model) {
            const py::gil_scoped_release release;
            return model.next().second;
          },
          "Why next_best_view gives none; empty where it gives one.")
      .def_property_readonly(
          "map", [](const GrowingModel& model) -> const VoxelMap& { return model.model().map; },
          py::return_value_policy::reference_internal, "The VoxelMap; it changes with every scan.")
      .def_property_readonly("current", &GrowingModel::current, "(4, 4), where the last scan was taken.")
      .def_property_readonly(
          "scans", [](const GrowingModel& model) { return model.model().scans; }, "List of ScanRecord.")
      .def(
          "cloud", [](const GrowingModel& model) { return model.model().surface.cloud(); },
          "The fused PointCloud, world frame; a copy.");
  const std::string read_help = with_options(
      "The ScanModel of all scans of a folder or a Stanford .conf; where no box is given it lies around all points.\n\n"
      "box here is cx,cy,cz,sx,sy,sz. on_scan(record): called after every scan.");
  module.def("read_scans", &model_of_folder, py::arg("path"), py::arg("on_scan") = py::none(), read_help.c_str());
}

}  // namespace vantage::python
