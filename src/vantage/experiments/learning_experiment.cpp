#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/experiments/error_experiments.hpp"
#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"

namespace vantage {
namespace {

constexpr double sigmas[] = {0.10, 0.20};  // metres per axis, which the learner does not know
constexpr std::size_t judged_scan = 10;    // the estimate after this many scans
constexpr double tolerance = 0.3;          // share of the truth within which it should be by then
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

bool close(double estimate, double sigma) { return std::abs(estimate / sigma - 1) <= tolerance; }

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

const std::array<std::string, 4> planners{"as if there were none", "told", "learned, half at first",
                                          "learned, twice at first"};
constexpr std::array<double, 4> believed_first{0, 0, 0.5, 2};  // of the robot's deviation, where it is learned

struct LearningCase {
  double sigma;
  std::array<RunGroup, planners.size()> groups;
};

std::string centimetres(double length) { return fmt::format("{:.0f} cm", 100 * length); }

void add_gain(ExperimentTable& table, double sigma, const std::vector<std::vector<RunOutcome>>& runs) {
  std::vector<std::vector<double>> coverage;
  for (const std::vector<RunOutcome>& method : runs) coverage.push_back(each(method, mean_coverage));
  for (std::size_t k = 0; k < planners.size(); ++k) {
    ExperimentTable::Cell against = std::monostate();
    if (k > 0) against = paired_difference(coverage[0], coverage[k]);
    const std::vector<double> views = each(runs[k], [](const RunOutcome& o) { return views_to(0.99, o); });
    table.rows.push_back(
        {fmt::format("{}: {}", centimetres(sigma), planners[k]), {estimate(coverage[k]), against, estimate(views)}});
  }
  for (std::size_t k = 2; k < planners.size(); ++k) {
    table.rows.push_back({fmt::format("{}: {} - told", centimetres(sigma), planners[k]),
                          {std::monostate(), paired_difference(coverage[1], coverage[k]), std::monostate()}});
  }
}

void add_estimates(ExperimentTable& table, double sigma, const std::vector<std::vector<RunOutcome>>& runs) {
  for (std::size_t k = 2; k < planners.size(); ++k) {
    const std::vector<double> learned =
        each(runs[k], [](const RunOutcome& o) { return after_scan(o, "learned_sigma", judged_scan); });
    const auto within = std::count_if(learned.begin(), learned.end(), [&](double each) { return close(each, sigma); });
    const auto [least, most] = std::minmax_element(learned.begin(), learned.end());
    table.rows.push_back({fmt::format("{}: {}", centimetres(sigma), planners[k]),
                          {estimate(learned), fmt::format("{} of {}", within, learned.size()),
                           fmt::format("{:.3f} to {:.3f}", *least, *most)}});
  }
}

/// How much less each planner has covered after each scan than the one that knows the error, with the interval over the
/// seeds.
LineChart chart_behind_told(double sigma, const std::vector<std::vector<RunOutcome>>& runs) {
  LineChart chart = chart_over_scans(
      fmt::format("error of {}: against the one that knows the error", centimetres(sigma)), "coverage [points]");
  // The one that knows the error too, as the line at zero, so that each planner looks as in the chart before.
  for (std::size_t k = 0; k < planners.size(); ++k) {
    LineSeries series;
    series.name = planners[k];
    for (std::size_t scan = 1; scan <= scans_shown; ++scan) {
      const auto coverage = [scan](const RunOutcome& o) { return 100 * after_scan(o, "coverage", scan); };
      const Estimate behind = paired_difference(each(runs[1], coverage), each(runs[k], coverage));
      series.x.push_back(static_cast<double>(scan));
      series.y.push_back(behind.mean);
      series.low.push_back(behind.low);
      series.high.push_back(behind.high);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void add_charts(ExperimentFigure& figure, double sigma, const std::vector<std::vector<RunOutcome>>& runs) {
  LineChart covered = chart_over_scans(fmt::format("error of {}", centimetres(sigma)), "coverage [%]");
  for (std::size_t k = 0; k < planners.size(); ++k)
    covered.series.push_back(curve_over_scans(planners[k], runs[k], "coverage", 0.01, scans_shown));
  LineChart deviation =
      chart_over_scans(fmt::format("error of {}: learned deviation", centimetres(sigma)), "sqrt(trace Sigma / 3) [m]");
  for (std::size_t k = 2; k < planners.size(); ++k)
    deviation.series.push_back(curve_over_scans(planners[k], runs[k], "learned_sigma", 1, scans_shown));
  deviation.series.push_back(level("the robot's", sigma));
  figure.plots.emplace_back(covered);
  figure.plots.emplace_back(chart_behind_told(sigma, runs));
  figure.plots.emplace_back(deviation);
}

}  // namespace

Experiment learning_experiment(const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  const PaperObject logo = paper_object("sgi_logo", options.folder());
  Experiment experiment("learning");
  const auto add = [&](double sigma, const std::string& method, const std::string& convolve,
                       const std::optional<std::string>& believed, const ExtraMeasures& extra) {
    ReconstructOptions run = free_flyer();
    run.positioning_error = Vec3::Constant(sigma);
    run.convolve = convolve;
    run.believed_error = believed;
    return experiment.add(runs_with_seeds(fmt::format("sgi_logo, {}, {}", centimetres(sigma), method), logo.object, run,
                                          options.seeds, extra));
  };
  std::vector<LearningCase> cases;
  for (const double sigma : sigmas) {
    LearningCase one{sigma, {}};
    for (std::size_t k = 0; k < planners.size(); ++k) {
      const double first = believed_first[k] * sigma;
      one.groups[k] = k < 2 ? add(sigma, planners[k], k == 0 ? "off" : "on", std::nullopt, {})
                            : add(sigma, planners[k], "on", fmt::format("learn:{0},{0},{0}", first), learned_sigma);
    }
    cases.push_back(one);
  }
  const std::string title = logo.title();
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable gain;
    gain.name = "learning";
    gain.title = "Learning the error against knowing it";
    gain.row_title = "error and planner";
    gain.columns = {
        {"coverage [%]", 2}, {"against as if there were none [points]", 2, Kind::difference}, {"views to 99 %", 1}};
    ExperimentTable estimates;
    estimates.name = "learning-estimate";
    estimates.title = fmt::format("The learned deviation after {} scans", judged_scan);
    estimates.row_title = "error and learner";
    estimates.note = "sqrt(trace Sigma / 3); at first the learner believes half or twice the robot's deviation.";
    estimates.columns = {{"learned [m]", 4}, {"within 30 %", 0}, {"least and most [m]", 0}};
    ExperimentFigure figure;
    figure.name = "learning-curves";
    figure.title = "Learning the positioning error while scanning";
    figure.note = "Bands: 95 % interval of the mean. A finished run keeps its last value.";
    for (const auto& [sigma, groups] : cases) {
      const auto runs = outcomes.paired({groups.begin(), groups.end()}, 2);
      gain.note = fmt::format("{}. Coverage: mean over scans {} to {}; {} seeds, paired.", title, first_compared_scan,
                              last_compared_scan, runs[0].size());
      add_gain(gain, sigma, runs);
      add_estimates(estimates, sigma, runs);
      add_charts(figure, sigma, runs);
    }
    return {gain, estimates, figure};
  };
  return experiment;
}

}  // namespace vantage
