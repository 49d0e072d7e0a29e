#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/experiments/error_experiments.hpp"
#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"

namespace vantage {
namespace {

constexpr double sigma = 0.10;           // metres per axis, which the learner does not know
constexpr std::size_t judged_scan = 10;  // the estimate after this many scans
constexpr double tolerance = 0.3;        // share of the truth within which it should be by then
constexpr std::size_t scans_shown = 18;

/// sqrt(trace Sigma / 3) of the position after each scan; 0 where nothing is learned.
const ExtraMeasures learned_sigma{
    "learned sigma 1", [](const SimulatedRun& run, const SimulatedObject&, RunOutcome& outcome) {
      for (const ScanRecord& scan : run.model.scans) {
        const double variance =
            scan.learned_error ? scan.learned_error->covariance.topLeftCorner<3, 3>().trace() / 3 : 0;
        outcome.lists["learned_sigma"].push_back(std::sqrt(variance));
      }
    }};

bool close(double estimate) { return std::abs(estimate / sigma - 1) <= tolerance; }

LineSeries level(const std::string& name, double value) {
  LineSeries series;
  series.name = name;
  series.x = {1, static_cast<double>(scans_shown)};
  series.y = {value, value};
  return series;
}

LineChart chart_over_scans(const std::string& title, const std::string& y) {
  LineChart chart;
  chart.title = title;
  chart.x.label = "scan";
  chart.x.ticks = PlotAxis::Ticks::whole;
  chart.y.label = y;
  return chart;
}

}  // namespace

Experiment learning_experiment(const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  const PaperObject logo = paper_object("sgi_logo", options.folder());
  Experiment experiment("learning");
  const auto add = [&](const std::string& method, const std::string& convolve,
                       const std::optional<std::string>& believed, const ExtraMeasures& extra) {
    ReconstructOptions run = free_flyer();
    run.positioning_error = Vec3::Constant(sigma);
    run.convolve = convolve;
    run.believed_error = believed;
    return experiment.add(runs_with_seeds("sgi_logo, " + method, logo.object, run, options.seeds, extra));
  };
  const RunGroup ignorant = add("as if there were none", "off", std::nullopt, {});
  const RunGroup told = add("told", "on", std::nullopt, {});
  const RunGroup learner = add("learned", "on", "learn", learned_sigma);
  const std::string title = logo.title();
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    const auto runs = outcomes.paired({ignorant, told, learner}, 2);
    std::vector<std::vector<double>> coverage, views;
    for (const std::vector<RunOutcome>& method : runs) {
      coverage.push_back(each(method, mean_coverage));
      views.push_back(each(method, [](const RunOutcome& o) { return views_to(0.99, o); }));
    }
    ExperimentTable gain;
    gain.name = "learning";
    gain.title = "Learning the error against knowing it";
    gain.row_title = "planner";
    gain.note = fmt::format("{}. Error: 10 cm per axis. Coverage: mean over scans {} to {}; {} seeds, paired.", title,
                            first_compared_scan, last_compared_scan, runs[0].size());
    gain.columns = {
        {"coverage [%]", 2}, {"against as if there were none [points]", 2, Kind::difference}, {"views to 99 %", 1}};
    const std::vector<std::string> names{"as if there were none", "told", "learned"};
    for (std::size_t k = 0; k < names.size(); ++k) {
      ExperimentTable::Cell against = std::monostate();
      if (k > 0) against = paired_difference(coverage[0], coverage[k]);
      gain.rows.push_back({names[k], {estimate(coverage[k]), against, estimate(views[k])}});
    }
    gain.rows.push_back(
        {"learned - told", {std::monostate(), paired_difference(coverage[1], coverage[2]), std::monostate()}});

    ExperimentTable estimates;
    estimates.name = "learning-estimate";
    estimates.title = fmt::format("The learned deviation after {} scans", judged_scan);
    estimates.row_title = "seed";
    estimates.note = fmt::format("sqrt(trace Sigma / 3); the robot's is {} m, the prior says 0.05 m.", sigma);
    estimates.columns = {{"learned [m]", 4}, {"within 30 %", 0}};
    int within = 0;
    std::vector<double> learned;
    for (std::size_t i = 0; i < runs[2].size(); ++i) {
      learned.push_back(after_scan(runs[2][i], "learned_sigma", judged_scan));
      within += close(learned.back()) ? 1 : 0;
      estimates.rows.push_back(
          {fmt::format("{}", i + 1), {estimate({learned.back()}), std::string(close(learned.back()) ? "yes" : "no")}});
    }
    estimates.rows.push_back({"all", {estimate(learned), fmt::format("{} of {}", within, learned.size())}});

    ExperimentFigure figure;
    figure.name = "learning-curves";
    figure.title = "Learning the positioning error while scanning";
    figure.note = "Bands: 95 % interval of the mean. A finished run keeps its last value.";
    LineChart covered = chart_over_scans(title, "coverage [%]");
    for (std::size_t k = 0; k < names.size(); ++k)
      covered.series.push_back(curve_over_scans(names[k], runs[k], "coverage", 0.01, scans_shown));
    LineChart deviation = chart_over_scans("learned deviation", "sqrt(trace Sigma / 3) [m]");
    deviation.series = {curve_over_scans("learned", runs[2], "learned_sigma", 1, scans_shown),
                        level("the robot's", sigma)};
    figure.plots = {covered, deviation};
    return {gain, estimates, figure};
  };
  return experiment;
}

}  // namespace vantage
