#include <fmt/format.h>

#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/tables.hpp"

namespace vantage {
namespace {

constexpr double sigma = 0.10;           // metres, per axis
constexpr std::size_t scans_shown = 18;  // the paper's longest run

struct Method {
  std::string name;
  bool errs, convolves;
};

const std::array<Method, 3> methods{
    {{"no error", false, false}, {"error", true, false}, {"error, convolved", true, true}}};

ReconstructOptions options_of(const Method& method) {
  ReconstructOptions options = free_flyer();
  if (method.errs) options.positioning_error = Vec3::Constant(sigma);
  if (method.convolves) options.convolve = "on";
  return options;
}

ExperimentTable::Row gain_row(const std::string& object, const std::vector<std::vector<RunOutcome>>& runs) {
  std::vector<std::vector<double>> means, views;
  for (const std::vector<RunOutcome>& method : runs) {
    means.push_back(each(method, mean_coverage));
    views.push_back(each(method, [](const RunOutcome& o) { return views_to(0.99, o); }));
  }
  return {object,
          {estimate(means[0]), estimate(means[1]), estimate(means[2]), paired_difference(means[1], means[2]),
           estimate(views[0]), estimate(views[1]), estimate(views[2]), paired_difference(views[2], views[1])}};
}

LineChart coverage_chart(const std::string& title, const std::vector<std::vector<RunOutcome>>& runs) {
  LineChart chart;
  chart.title = title;
  chart.x.label = "scan";
  chart.x.ticks = PlotAxis::Ticks::whole;
  chart.y.label = "coverage [%]";
  for (std::size_t k = 0; k < methods.size(); ++k)
    chart.series.push_back(curve_over_scans(methods[k].name, runs[k], "coverage", 0.01, scans_shown));
  return chart;
}

Experiment positioning_error_figure(const std::string& name, const std::vector<std::string>& object_names,
                                    const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  ExperimentFigure figure;
  figure.name = name;
  figure.title = fmt::format("Figure {}: reconstruction with positioning error", name.substr(6));
  figure.note = fmt::format(
      "Mean coverage after each scan over {} paired seeds, bands: 95 % interval of the mean. Error: 10 cm per axis. A "
      "finished run keeps its last value.",
      options.seeds);
  ExperimentTable table;
  table.name = name + "-gain";
  table.title = "What convolution gains";
  table.note = fmt::format("Coverage: mean over scans {} to {}, differences paired by seed.", first_compared_scan,
                           last_compared_scan);
  table.columns = {{"no error [%]", 2},
                   {"error [%]", 2},
                   {"convolved [%]", 2},
                   {"gain [points]", 2, Kind::difference},
                   {"views to 99 %, no error", 1},
                   {"error", 1},
                   {"convolved", 1},
                   {"views saved", 1, Kind::difference}};
  Experiment experiment(name);
  std::vector<std::pair<PaperObject, std::vector<RunGroup>>> objects;
  for (const std::string& object_name : object_names) {
    const PaperObject object = paper_object(object_name, options.folder());
    std::vector<RunGroup> groups;
    for (const Method& method : methods) {
      groups.push_back(experiment.add(runs_with_seeds(fmt::format("{}, {}", object_name, method.name), object.object,
                                                      options_of(method), options.seeds)));
    }
    objects.emplace_back(object, groups);
  }
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentFigure drawn = figure;
    ExperimentTable filled = table;
    for (const auto& [object, groups] : objects) {
      const auto runs = outcomes.paired(groups, 2);
      drawn.plots.emplace_back(coverage_chart(object.title(), runs));
      filled.rows.push_back(gain_row(object.object->name(), runs));
    }
    return {drawn, filled};
  };
  return experiment;
}

}  // namespace

Experiment simple_objects_figure(const ExperimentOptions& options) {
  return positioning_error_figure("figure10", {"sphere", "mug"}, options);
}
Experiment logo_figure(const ExperimentOptions& options) {
  return positioning_error_figure("figure11", {"sgi_logo"}, options);
}

}  // namespace vantage
