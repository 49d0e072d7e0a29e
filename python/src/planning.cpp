#include <set>

#include "bindings.hpp"
#include "options.hpp"
#include "utility.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/planning/planner.hpp"

namespace vantage::python {
namespace {

/// The planner's options as ReconstructOptions has them, so that names, defaults and meanings are those of the
/// command line. Camera, candidates and utility are arguments of their own.
std::vector<OptionField> planner_fields(ReconstructOptions& options) {
  std::vector<std::string> names = planning_option_names();
  names.insert(names.end(), {"believed-error", "believed-orientation-error", "believed-mean", "believed-covariance",
                             "believed-growth", "convolve", "error-candidates", "error-samples", "least-overlap"});
  std::erase_if(names, [](const std::string& name) {
    return name == "camera" || name == "candidates" || name == "depth-range" || name == "max-incidence" ||
           name == "utility" || name == "plan";
  });
  return fields_named(option_fields(options), names);
}

std::unique_ptr<Planner> make_planner(const Candidates& candidates, const RangeCamera& camera,
                                      const AnyUtility& utility, const py::kwargs& keywords) {
  ReconstructOptions options;
  std::set<std::string> given;
  set_options(noting(planner_fields(options), given), keywords, "Planner");
  options.utility = name_of(utility).value_or(options.utility);
  given.insert("utility");
  camera.validate();
  load_robot(options, given);
  options.validate();
  const std::optional<Utility> function = utility_of(utility);
  if (function) return std::make_unique<Planner>(candidates, camera, options.planner_options(), *function);
  return std::make_unique<Planner>(candidates, camera, options.planner_options());
}

std::string planner_help() {
  ReconstructOptions options;
  return "Plans one view after the other.\n\nutility: the name of one, or a function that takes (Visibility, Factors) "
         "of a view and returns a number, higher is better (it may be asked more than once about a view), or a "
         "SetUtility.\nOptions by keyword, as on the command line:\n\n" +
         options_text(planner_fields(options));
}

void bind_candidates(py::module_& module) {
  py::class_<Candidates>(module, "Candidates", "The views to choose from; the index of a view is its identity.")
      .def_static("sphere", &view_sphere, py::arg("count"), py::arg("radius"), py::arg("center") = Vec3(Vec3::Zero()),
                  "View sphere: count = 20 * 4**k views at `radius` metres from center (3,), looking at it.")
      .def_static(
          "cube",
          [](int n, const Vec3& side, double inner_radius, double outer_radius, const Vec3& center) {
            return view_cube(n, side, inner_radius, outer_radius, center);
          },
          py::arg("n"), py::arg("side"), py::arg("inner_radius"), py::arg("outer_radius"),
          py::arg("center") = Vec3(Vec3::Zero()),
          "View cube: the centres of n**3 cells of a box with edges side (3,), kept where they lie within the radii of "
          "center (3,), looking at it. Metres.")
      .def_static("from_text", &candidates_from_text, py::arg("text"), py::arg("center") = Vec3(Vec3::Zero()),
                  "As on the command line: 'sphere:80:2' or 'cube:17:4.1:0.82:1.9'.")
      .def(py::init([](const std::vector<View>& views, const Vec3& center) {
             require(!views.empty(), "views: there are none; must be (N, 4, 4)");
             return Candidates{Candidates::Kind::list, center, views, {}};
           }),
           py::arg("views"), py::arg("center"), "Views of one's own, (N, 4, 4) world from sensor, around center (3,).")
      .def_property_readonly(
          "views",
          [](const Candidates& candidates) {
            std::vector<double> numbers;
            numbers.reserve(16 * candidates.views.size());
            for (const View& view : candidates.views) {
              for (int row = 0; row < 4; ++row) {
                for (int column = 0; column < 4; ++column) numbers.push_back(view.world_from_sensor(row, column));
              }
            }
            return array_of<double>(std::move(numbers), {static_cast<py::ssize_t>(candidates.views.size()), 4, 4});
          },
          "(N, 4, 4), world from sensor, metres.")
      .def_readonly("center", &Candidates::center, "(3,), metres.")
      .def("__len__", [](const Candidates& candidates) { return candidates.views.size(); });
}

void bind_planner(py::module_& module) {
  py::class_<Evaluation>(module, "Evaluation", "A candidate view with all that was found out about it.")
      .def_readonly("candidate", &Evaluation::candidate, "Index among the candidates.")
      .def_readonly("view", &Evaluation::view, "(4, 4), world from sensor, metres.")
      .def_readonly("feasible", &Evaluation::feasible)
      .def_readonly("reason", &Evaluation::reason, "Why it is not feasible; empty where it is.")
      .def_readonly("resolution", &Evaluation::resolution, "(columns, rows) of the rays; (0, 0): not evaluated.")
      .def_readonly("seen", &Evaluation::seen)
      .def_readonly("factors", &Evaluation::factors)
      .def_readonly("utility", &Evaluation::utility)
      .def_readonly("score", &Evaluation::score,
                    "What the ranking goes by: the utility, or the expected one under positioning error.")
      .def("__repr__", [](const Evaluation& e) {
        if (!e.feasible) return concat("<vantage.Evaluation of view ", e.candidate, ", not feasible: ", e.reason, ">");
        return concat("<vantage.Evaluation of view ", e.candidate, ", utility ", e.utility, ">");
      });
  py::class_<Plan>(module, "Plan", "The next best view with all that led to it.")
      .def_readonly("best", &Plan::best)
      .def_readonly("ranking", &Plan::ranking, "Views that were evaluated to the end, best first.")
      .def_readonly("infeasible", &Plan::infeasible, "Candidates that fell out, with the reason.")
      .def_readonly("explanation", &Plan::explanation, "One sentence for people.")
      .def("__repr__", [](const Plan& plan) { return "<vantage.Plan " + plan.explanation + ">"; });
  const std::string help = planner_help();
  py::class_<Planner>(module, "Planner", help.c_str())
      .def(py::init(&make_planner), py::arg("candidates"), py::arg("camera"), py::arg("utility") = "combined",
           "See the class for the options.")
      .def("next_best_view", &Planner::next_best_view, py::arg("map"), py::arg("current"),
           py::call_guard<py::gil_scoped_release>(),
           "The Plan for the view to take next from `current` (4x4, world from sensor), or None where nothing is left "
           "to "
           "see; why_finished then says so.")
      .def(
          "discard", [](Planner& p, int candidate, const std::string& reason) { p.discard(candidate, reason); },
          py::arg("candidate"), py::arg("reason"), "The robot cannot reach this candidate: it is not planned again.")
      .def(
          "set_aside", [](Planner& p, int candidate, const std::string& reason) { p.set_aside(candidate, reason); },
          py::arg("candidate"), py::arg("reason"),
          "This candidate's scan could not be used: it is not planned again until map_changed().")
      .def("scanned", &Planner::scanned, py::arg("view"), py::arg("candidate") = -1,
           "A scan from this view (4x4) was merged: for utilities that look at the views so far. -1: no candidate.")
      .def(
          "map_changed", [](Planner& p) { p.map_changed(); }, "Views that were set aside may be planned again.")
      .def_property_readonly(
          "why_finished", [](Planner& p) { return p.why_finished(); }, "Why there is no next view.")
      .def_property_readonly(
          "candidates", [](Planner& p) { return p.candidates(); }, "Candidates; a copy.")
      .def_property_readonly(
          "camera", [](Planner& p) { return p.camera(); }, "RangeCamera; a copy.");
}

std::vector<double> convolve_utilities(const DoubleArray& utilities, const Candidates& candidates,
                                       const std::optional<Vec3>& sigma, const std::optional<Mat3>& covariance,
                                       const Vec3& mean, bool normalise, std::optional<double> truncate_sigmas) {
  require_shape(utilities, {static_cast<py::ssize_t>(candidates.views.size())}, "utilities (one per candidate)");
  require(sigma.has_value() != covariance.has_value(), "convolve: must have either sigma or covariance");
  PositioningError error =
      sigma ? PositioningError::from_deviations(*sigma) : PositioningError{Vec3::Zero(), *covariance};
  error.mean = mean;
  error.validate();
  const ConvolutionOptions options{.normalise = normalise, .truncate_sigmas = truncate_sigmas};
  options.validate();
  const std::span<const double> values(utilities.data(), candidates.views.size());
  const py::gil_scoped_release release;
  return convolve(values, candidates, error, options);
}

}  // namespace

void bind_planning(py::module_& module) {
  bind_candidates(module);
  bind_planner(module);
  module.def(
      "why_infeasible",
      [](const VoxelMap& map, const View& view, double body_radius, const std::optional<Box3>& workspace,
         const std::vector<Box3>& obstacles) {
        const ReachOptions reach{body_radius, workspace, obstacles};
        reach.validate();
        return why_infeasible(map, view, reach);
      },
      py::arg("map"), py::arg("view"), py::kw_only(), py::arg("body_radius") = 0.0, py::arg("workspace") = py::none(),
      py::arg("obstacles") = std::vector<Box3>(),
      "Why the robot cannot be at a view (4x4), or None. body_radius in metres; boxes (2, 3): least, greatest corner.");
  module.def(
      "convolve",
      [](const DoubleArray& utilities, const Candidates& candidates, const std::optional<Vec3>& sigma,
         const std::optional<Mat3>& covariance, const Vec3& mean, bool normalise, std::optional<double> truncate) {
        const auto count = static_cast<py::ssize_t>(candidates.views.size());
        return array_of<double>(convolve_utilities(utilities, candidates, sigma, covariance, mean, normalise, truncate),
                                {count});
      },
      py::arg("utilities"), py::arg("candidates"), py::kw_only(), py::arg("sigma") = py::none(),
      py::arg("covariance") = py::none(), py::arg("mean") = Vec3(Vec3::Zero()), py::arg("normalise") = false,
      py::arg("truncate_sigmas") = py::none(),
      "Convolution after evaluation (section 7 of the paper): the expected utility (N,) of each candidate when the "
      "robot "
      "errs by sigma (3,) metres per axis or a covariance (3, 3), around mean (3,).");
}

}  // namespace vantage::python
