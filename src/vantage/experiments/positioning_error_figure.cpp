#include <fmt/format.h>

#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/tables.hpp"

namespace vantage {
namespace {

constexpr double figure11_sigma = 0.10;       // metres, per axis
constexpr std::size_t longest_run = 18;       // the paper's longest run
constexpr double published_coverage = 0.995;  // that figure 11 goes up to

struct ConvolutionMethod {
  std::string name;
  bool errs, convolves;
  double logo_views;  // to 99.5 % of the SGI logo as published (section 9)
};

const std::array<ConvolutionMethod, 3> convolution_methods{
    {{"no error", false, false, 9}, {"error", true, false, 18}, {"error, convolved", true, true, 12}}};

ReconstructOptions options_of(const ConvolutionMethod& method) {
  ReconstructOptions options = free_flyer();
  if (method.errs) options.positioning_error = Vec3::Constant(figure11_sigma);
  if (method.convolves) options.convolve = "on";
  return options;
}

bool is_logo(const PaperObject& object) { return object.object->name() == std::string("sgi_logo"); }

ExperimentTable::Row gain_row(const PaperObject& object, const std::vector<std::vector<RunOutcome>>& runs) {
  std::vector<std::vector<double>> means;
  for (const std::vector<RunOutcome>& method : runs) means.push_back(each(method, mean_coverage));
  ExperimentTable::Row row{object.object->name(), {}};
  for (const std::vector<double>& mean : means) row.cells.emplace_back(estimate(mean));
  row.cells.emplace_back(paired_difference(means[1], means[2]));
  return row;
}

ExperimentTable::Row views_row(const PaperObject& object, const std::vector<std::vector<RunOutcome>>& runs,
                               double coverage) {
  ExperimentTable::Row row{fmt::format("{}, {:.3g} %", object.object->name(), 100 * coverage), {}};
  std::vector<std::vector<double>> views;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    views.push_back(each(runs[k], [coverage](const RunOutcome& o) { return views_to(coverage, o); }));
    Estimate needed = estimate(views.back());
    if (is_logo(object) && coverage == published_coverage) needed.published = convolution_methods[k].logo_views;
    row.cells.emplace_back(needed);
  }
  row.cells.emplace_back(paired_difference(views[2], views[1]));
  return row;
}

LineChart coverage_chart(const PaperObject& object, const std::vector<std::vector<RunOutcome>>& runs) {
  LineChart chart;
  chart.title = object.title();
  chart.x.label = "scan";
  chart.x.ticks = PlotAxis::Ticks::whole;
  chart.y.label = "coverage [%]";
  for (std::size_t k = 0; k < convolution_methods.size(); ++k) {
    chart.series.push_back(curve_over_scans(convolution_methods[k].name, runs[k], "coverage", 0.01, longest_run));
    if (is_logo(object)) chart.paper.push_back({convolution_methods[k].logo_views, 100 * published_coverage});
  }
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
  table.columns = {{"no error [%]", 2}, {"error [%]", 2}, {"convolved [%]", 2}, {"gain [points]", 2, Kind::difference}};
  ExperimentTable needed;
  needed.name = name + "-views";
  needed.title = "Scans until a share of the surface is covered";
  needed.note = "Differences paired by seed. A run that ends before counts with one scan more than it took.";
  needed.row_title = "object and share";
  needed.columns = {{"no error", 1}, {"error", 1}, {"convolved", 1}, {"saved by convolution", 1, Kind::difference}};
  Experiment experiment(name);
  std::vector<std::pair<PaperObject, std::vector<RunGroup>>> objects;
  for (const std::string& object_name : object_names) {
    const PaperObject object = paper_object(object_name, options.folder());
    std::vector<RunGroup> groups;
    for (const ConvolutionMethod& method : convolution_methods) {
      groups.push_back(experiment.add(runs_with_seeds(fmt::format("{}, {}", object_name, method.name), object.object,
                                                      options_of(method), options.seeds)));
    }
    objects.emplace_back(object, groups);
  }
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentFigure drawn = figure;
    ExperimentTable filled = table, views = needed;
    for (const auto& [object, groups] : objects) {
      const auto runs = outcomes.paired(groups, 2);
      drawn.plots.emplace_back(coverage_chart(object, runs));
      filled.rows.push_back(gain_row(object, runs));
      for (const double coverage : {0.95, 0.99, published_coverage})
        views.rows.push_back(views_row(object, runs, coverage));
    }
    return {drawn, filled, views};
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
