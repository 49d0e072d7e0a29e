#include "utility.hpp"

#include <cmath>

#include "bindings.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/utility/registry.hpp"

namespace vantage::python {
namespace {

/// A Choice that a Python function may keep for longer than the choice lives; it then refuses.
struct ChoiceHolder {
  const Choice* choice = nullptr;

  [[nodiscard]] const Choice& get() const {
    require(choice != nullptr, "choice: is over; a utility may look at it only while it is being called");
    return *choice;
  }
  [[nodiscard]] const ViewToJudge& view(std::size_t i) const {
    require(i < get().views.size(), "view = ", i, ": must be below ", get().views.size(), ", the number of views");
    return get().views[i];
  }
};

double number_of(const py::object& result) {
  const double utility = PyFloat_AsDouble(result.ptr());
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  require(std::isfinite(utility), "utility: returned ", utility, "; must be a finite number");
  return utility;
}

CountUtility calling(const CountFunction& function) {
  return [function](const Visibility& seen, const Factors& found) {
    const py::gil_scoped_acquire acquire;
    return number_of(function(seen, found));
  };
}

/// Destroyed with the interpreter's lock: the planner's own copies go when it does not hold it.
std::shared_ptr<const py::function> shared(const py::function& function) {
  return {new py::function(function), [](const py::function* pointer) {
            const py::gil_scoped_acquire acquire;
            delete pointer;
          }};
}

SetUtility calling_once(const py::function& given) {
  return [function = shared(given)](const Choice& choice) {
    const py::gil_scoped_acquire acquire;
    const auto holder = std::make_shared<ChoiceHolder>(ChoiceHolder{&choice});
    const struct Ended {
      ChoiceHolder& holder;
      ~Ended() { holder.choice = nullptr; }
    } ended{*holder};
    const py::object result = (*function)(holder);
    const auto scores = DoubleArray::ensure(result);
    if (!scores) throw py::type_error("utility: must return one number for each view");
    require_shape(scores, {static_cast<py::ssize_t>(choice.views.size())}, "scores of the utility");
    return std::vector<double>(scores.data(), scores.data() + scores.size());
  };
}

void bind_choice(py::module_& module) {
  py::class_<ViewToJudge>(module, "ViewToJudge", "A feasible view that a utility is asked about.")
      .def_readonly("candidate", &ViewToJudge::candidate, "Index among the candidates.")
      .def_readonly("view", &ViewToJudge::view, "(4, 4), world from sensor, metres.")
      .def_readonly("resolution", &ViewToJudge::resolution, "(columns, rows) of the rays that it was seen with.")
      .def_readonly("ideal", &ViewToJudge::ideal, "Eq. 14: (columns, rows) at which rays are one voxel apart.")
      .def_readonly("travel", &ViewToJudge::travel, "From the current view: x of eq. 10, in [0, 1].")
      .def_readonly("seen", &ViewToJudge::seen, "Visibility.")
      .def_readonly("factors", &ViewToJudge::factors, "Factors.");
  py::class_<ChoiceHolder, std::shared_ptr<ChoiceHolder>>(
      module, "Choice", "The moment at which a view is to be chosen; to be looked at only while the utility is called.")
      .def_property_readonly(
          "map", [](const ChoiceHolder& holder) -> const VoxelMap& { return holder.get().map; },
          py::return_value_policy::reference, "The VoxelMap that is planned on.")
      .def_property_readonly(
          "camera", [](const ChoiceHolder& holder) { return holder.get().camera; }, "RangeCamera; a copy.")
      .def_property_readonly(
          "current", [](const ChoiceHolder& holder) { return holder.get().current; }, "(4, 4), world from sensor.")
      .def_property_readonly(
          "scanned",
          [](const ChoiceHolder& holder) {
            return std::vector<View>(holder.get().scanned.begin(), holder.get().scanned.end());
          },
          "Views from which scans were merged, in their order: a list of (4, 4).")
      .def_property_readonly(
          "seed", [](const ChoiceHolder& holder) { return holder.get().seed; }, "For utilities that draw.")
      .def_property_readonly(
          "views",
          [](const ChoiceHolder& holder) {
            return std::vector<ViewToJudge>(holder.get().views.begin(), holder.get().views.end());
          },
          "The feasible views: a list of ViewToJudge.")
      .def(
          "visible_voxels",
          [](const ChoiceHolder& holder, std::size_t i) {
            const ViewToJudge& view = holder.view(i);
            const Choice& choice = holder.get();
            std::vector<Index3> voxels;
            {
              const py::gil_scoped_release release;
              voxels = choice.visibility.visible_voxels(choice.camera, view.view, view.resolution);
            }
            return rows_of(std::move(voxels));
          },
          py::arg("view"), "What views[view] sees: (n, 3) int32 scene indices, x fastest.");
  py::class_<SetFunction>(
      module, "SetUtility",
      "A utility that scores all views at once: function(choice) takes a Choice and returns one finite number for each "
      "of "
      "choice.views, in their order; higher is better, 0 or less is not worth a scan.")
      .def(py::init([](const py::function& function, bool needs_all_views, bool skips_scanned_views) {
             return SetFunction{function, needs_all_views, skips_scanned_views};
           }),
           py::arg("function"), py::kw_only(), py::arg("needs_all_views") = false,
           py::arg("skips_scanned_views") = false,
           "needs_all_views: it compares views, so it is asked once per plan, and multi-resolution search refuses it. "
           "skips_scanned_views: never choose a view twice.");
}

void bind_factors(py::module_& module) {
  py::class_<Factors>(module, "Factors", "The factors of a view's utility (section 5 of the paper).")
      .def_readonly("x_oc", &Factors::x_oc, "Share of occupied voxels among the visible ones.")
      .def_readonly("x_op", &Factors::x_op, "Share of occplane voxels among the visible ones.")
      .def_readonly("f_area", &Factors::f_area, "Eq. 7.")
      .def_readonly("f_navigation", &Factors::f_navigation, "Eq. 10.")
      .def_readonly("f_quality", &Factors::f_quality, "Eq. 11.")
      .def_readonly("f_occlusion", &Factors::f_occlusion, "Eq. 12.")
      .def("__repr__", [](const Factors& f) {
        return concat("<vantage.Factors area ", f.f_area, ", navigation ", f.f_navigation, ", quality ", f.f_quality,
                      ", occlusion ", f.f_occlusion, ">");
      });
  module.def(
      "factors",
      [](const Visibility& seen, double distance, double alpha_oc, double alpha_op, double rho, bool navigation) {
        const UtilityOptions options{alpha_oc, alpha_op, rho, navigation};
        options.validate();
        return factors(seen, distance, options);
      },
      py::arg("seen"), py::arg("normalised_distance"), py::kw_only(), py::arg("alpha_oc") = 0.2,
      py::arg("alpha_op") = 0.8, py::arg("rho") = 0.2, py::arg("navigation") = true,
      "The factors of a view that sees this, normalised_distance (0 to 1, eq. 10) from the current one.");
  module.def("combined_utility", &combined_utility, py::arg("factors"), "Eq. 13.");
  module.def("gua_utility", &gua_utility, py::arg("factors"), "Eq. 21, the greatest unknown area.");
  module.def("utility_names", &utility_names, "Names of the utilities that Planner knows.");
}

}  // namespace

std::optional<std::string> name_of(const AnyUtility& utility) {
  const auto* name = std::get_if<std::string>(&utility);
  return name == nullptr ? std::nullopt : std::optional(*name);
}

std::optional<Utility> utility_of(const AnyUtility& utility) {
  if (const auto* function = std::get_if<CountFunction>(&utility)) return Utility{.score = calling(*function)};
  if (const auto* given = std::get_if<SetFunction>(&utility)) {
    return Utility{calling_once(given->function), given->needs_all_views, given->skips_scanned_views};
  }
  return std::nullopt;
}

void bind_utility(py::module_& module) {
  bind_factors(module);
  bind_choice(module);
}

}  // namespace vantage::python
