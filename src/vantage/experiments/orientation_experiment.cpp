#include <fmt/format.h>

#include "vantage/experiments/error_experiments.hpp"
#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"

namespace vantage {
namespace {

constexpr double position_sigma = 0.05;  // metres
constexpr double angle_sigma = 3;        // degrees
constexpr std::size_t scans_drawn = 16;

struct Setting {
  const char* name;
  ReconstructOptions options;
};

std::vector<Setting> settings() {
  ReconstructOptions sphere;
  sphere.max_views = 30;
  std::vector<Setting> result{{"free flyer, 92.5 degrees", free_flyer()}, {"view sphere, 45 degrees", sphere}};
  for (Setting& each : result) {
    each.options.positioning_error = Vec3::Constant(position_sigma);
    each.options.orientation_error = Vec3::Constant(angle_sigma);
  }
  return result;
}

struct OrientationCase {
  std::string title;
  RunGroup ignorant, sampled;
};

}  // namespace

Experiment orientation_experiment(const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  Experiment experiment("orientation");
  std::vector<OrientationCase> cases;
  for (const std::string object_name : {"mug", "sgi_logo"}) {
    const PaperObject object = paper_object(object_name, options.folder());
    for (const Setting& setting : settings()) {
      const auto add = [&](const char* method, const std::string& convolve) {
        ReconstructOptions run = setting.options;
        run.convolve = convolve;
        return experiment.add(runs_with_seeds(fmt::format("{}, {}, {}", object_name, setting.name, method),
                                              object.object, run, options.seeds));
      };
      const RunGroup ignorant = add("as if there were none", "off");
      const RunGroup sampled = add("sampled poses", "samples");
      cases.push_back({fmt::format("{}: {}", object.title(), setting.name), ignorant, sampled});
    }
  }
  const int seeds = options.seeds;
  experiment.report = [cases, seeds](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable table;
    table.name = "orientation";
    table.title = "Planning for errors of position and orientation";
    table.note = fmt::format(
        "Every move errs by 5 cm per axis and by 3 degrees of pan, tilt and roll; true poses in the map. Coverage: "
        "mean "
        "over scans {} to {}. {} seeds, differences paired by seed.",
        first_compared_scan, last_compared_scan, seeds);
    table.columns = {{"as if there were none [%]", 2}, {"sampled poses [%]", 2}, {"gain [points]", 2, Kind::difference},
                     {"views to 99 %, none", 1},       {"sampled", 1},           {"views saved", 2, Kind::difference}};
    ExperimentFigure figure;
    figure.name = "orientation-coverage";
    figure.title = "Coverage with errors of 5 cm and 3 degrees";
    figure.note = "Bands: 95 % interval of the mean. A finished run keeps its last value.";
    for (const OrientationCase& each_case : cases) {
      const auto runs = outcomes.paired({each_case.ignorant, each_case.sampled}, 2);
      const auto views = [](const RunOutcome& o) { return views_to(0.99, o); };
      const std::vector<double> without = each(runs[0], mean_coverage);
      const std::vector<double> with = each(runs[1], mean_coverage);
      const std::vector<double> views_without = each(runs[0], views);
      const std::vector<double> views_with = each(runs[1], views);
      table.rows.push_back(
          {each_case.title,
           {estimate(without), estimate(with), paired_difference(without, with), estimate(views_without),
            estimate(views_with), paired_difference(views_with, views_without)}});
      LineChart chart;
      chart.title = each_case.title;
      chart.x.label = "scan";
      chart.x.ticks = PlotAxis::Ticks::whole;
      chart.y.label = "coverage [%]";
      chart.series = {curve_over_scans("as if there were none", runs[0], "coverage", 0.01, scans_drawn),
                      curve_over_scans("sampled poses", runs[1], "coverage", 0.01, scans_drawn)};
      figure.plots.emplace_back(chart);
    }
    return {table, figure};
  };
  return experiment;
}

}  // namespace vantage
