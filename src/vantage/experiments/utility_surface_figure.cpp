#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/tables.hpp"
#include "vantage/simulation/simulated_robot.hpp"

namespace vantage {
namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();
constexpr double sigma = 0.10;         // metres, per axis
constexpr int cells = 33;              // per side of the cube; odd, so that a layer goes through the object's middle
constexpr double side = 4.1;           // metres
constexpr double neighbourhood = 0.2;  // metres, two standard deviations

/// Section 9 of the paper, with a finer cube.
ReconstructOptions finer_free_flyer() {
  ReconstructOptions options = free_flyer();
  options.candidates = fmt::format("cube:{}:{}:0.82:1.9", cells, side);
  options.positioning_error = Vec3::Constant(sigma);
  options.convolve = "on";
  return options;
}

struct Views {
  Candidates candidates;
  std::vector<double> utility, expected;  // per candidate; NaN where infeasible
};

/// The candidates of the middle layer as a grid of values, row 0 at the least y.
std::vector<double> middle_layer_of(const Candidates& candidates, const std::vector<double>& values) {
  std::vector<double> layer(static_cast<std::size_t>(cells * cells), not_there);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Index3& cell = candidates.grid->cell_of_view[i];
    if (cell.z() == cells / 2) layer[static_cast<std::size_t>(cell.y() * cells + cell.x())] = values[i];
  }
  return layer;
}

/// What the robot can be sure of at a view: its utility there, the mean and the least of the views around it that an
/// error of two standard deviations leads to.
void describe_view(const Views& views, std::size_t best, const std::string& name, RunOutcome& outcome) {
  const Vec3 place = views.candidates.views[best].position();
  double sum = 0, least = views.utility[best];
  int count = 0;
  for (std::size_t i = 0; i < views.utility.size(); ++i) {
    if ((views.candidates.views[i].position() - place).norm() > neighbourhood) continue;
    const double utility = std::isnan(views.utility[i]) ? 0 : views.utility[i];
    sum += utility;
    least = std::min(least, utility);
    ++count;
  }
  outcome.numbers[name + " candidate"] = static_cast<double>(best);
  outcome.numbers[name + " utility"] = views.utility[best];
  outcome.numbers[name + " mean"] = sum / count;
  outcome.numbers[name + " least"] = least;
  outcome.lists[name + " position"] = {place.x(), place.y(), place.z()};
}

std::size_t best_of(const std::vector<double>& values) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::isnan(values[best]) || values[i] > values[best]) best = i;
  return best;
}

RunOutcome evaluate_cube(const SweepObject& object, const ReconstructOptions& options) {
  const std::shared_ptr<const RangeScanner> scanner = object.scanner(options);
  Planner planner(options.candidate_views(), options.range_camera(), options.planner_options());
  SimulatedRobot robot(*scanner, options.range_camera(), {}, options.seed);
  ObjectModel model(options.scene_options(), options.point_spacing());
  TrustingRegistrar registrar;
  const View first = planner.candidates().views[static_cast<std::size_t>(options.initial_view)];
  require(robot.move_to(first), "the robot cannot reach its first view");
  model.scans.push_back(update(model, scan_of(robot.take_range_image()), robot.view(), registrar));
  const std::optional<Plan> plan = planner.next_best_view(model.map, robot.view());
  if (!plan) throw Error("no view is left after the first scan");

  Views views{planner.candidates(), {}, {}};
  views.utility.assign(views.candidates.views.size(), not_there);
  views.expected = views.utility;
  for (const Evaluation& each : plan->ranking) {
    views.utility[static_cast<std::size_t>(each.candidate)] = each.utility;
    views.expected[static_cast<std::size_t>(each.candidate)] = each.score;
  }
  RunOutcome outcome;
  outcome.lists["utility"] = middle_layer_of(views.candidates, views.utility);
  outcome.lists["expected"] = middle_layer_of(views.candidates, views.expected);
  describe_view(views, best_of(views.utility), "before", outcome);
  describe_view(views, best_of(views.expected), "after", outcome);
  return outcome;
}

SurfacePlot surface(const std::string& title, const std::string& value, const std::vector<double>& values) {
  SurfacePlot plot;
  plot.title = title;
  plot.grid = {cells,    cells,   values,  -side / 2, side / 2, -side / 2,
               side / 2, "x [m]", "y [m]", value,     0.0,      std::nullopt};
  return plot;
}

ExperimentTable::Row view_row(const RunOutcome& outcome, const std::string& name) {
  const std::vector<double>& place = outcome.list(name + " position");
  return {name == "before" ? "best before convolution" : "best after convolution",
          {fmt::format("{:.2f}, {:.2f}, {:.2f}", place[0], place[1], place[2]),
           estimate({outcome.number(name + " utility")}), estimate({outcome.number(name + " mean")}),
           estimate({outcome.number(name + " least")})}};
}

}  // namespace

Experiment utility_surface_figure(const ExperimentOptions& options) {
  const PaperObject logo = paper_object("sgi_logo", options.folder());
  ReconstructOptions run = finer_free_flyer();
  run.validate();
  // A view in the middle layer, seen from -x.
  const Candidates candidates = run.candidate_views();
  const auto& cell_of_view = candidates.grid->cell_of_view;
  run.initial_view = static_cast<int>(
      std::find(cell_of_view.begin(), cell_of_view.end(), Index3(4, cells / 2, cells / 2)) - cell_of_view.begin());
  const nlohmann::ordered_json configuration{{"kind", "utility surface"},        {"object", logo.object->name()},
                                             {"mesh", logo.object->digest()},    {"camera", run.camera},
                                             {"candidates", run.candidates},     {"positioning-error", sigma},
                                             {"initial-view", run.initial_view}, {"neighbourhood", neighbourhood}};
  Experiment experiment("figure7");
  const RunGroup only =
      experiment.add({{"figure7, sgi_logo", configuration.dump(),
                       [object = logo.object, run](const Interrupted&) { return evaluate_cube(*object, run); }}});
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    const RunOutcome outcome = outcomes.of(only).front();
    ExperimentFigure figure;
    figure.name = "figure7";
    figure.title = "Figure 7: utility of the views before and after convolution";
    figure.note = fmt::format(
        "The {} after one scan; views of the cube's middle layer, {} cells per side between 0.82 and 1.9 m from the "
        "middle. Error: 10 cm per axis. As in eq. 20 the kernel is not normalised, so the heights of the two differ.",
        logo.title(), cells);
    figure.plots = {surface("before convolution", "utility", outcome.list("utility")),
                    surface("after convolution", "expected", outcome.list("expected"))};
    ExperimentTable table;
    table.name = "figure7-best";
    table.title = "The next best view moves to a safe place";
    table.note = fmt::format("Utilities of the views within {:.1f} m (two standard deviations) of the planned one.",
                             neighbourhood);
    table.row_title = "view";
    table.columns = {{"position [m]"}, {"utility", 3}, {"mean around it", 3}, {"least around it", 3}};
    table.rows = {view_row(outcome, "before"), view_row(outcome, "after")};
    return {figure, table};
  };
  return experiment;
}

}  // namespace vantage
