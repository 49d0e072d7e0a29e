#include <fmt/format.h>

#include <algorithm>

#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/tables.hpp"

namespace vantage {
namespace {

constexpr double sigma = 0.10;           // metres, per axis
constexpr std::size_t scans_shown = 18;  // the paper's longest run
constexpr std::size_t first_compared = 2, last_compared = 10;

struct Method {
  std::string name;
  bool errs, convolves;
};

const std::array<Method, 3> methods{
    {{"no error", false, false}, {"error", true, false}, {"error, convolved", true, true}}};

/// Section 9 of the paper.
ReconstructOptions free_flyer() {
  ReconstructOptions options;
  options.camera = "92.5x72.32:320x240";
  options.candidates = "cube:17:4.1:0.82:1.9";
  options.navigation = false;
  options.max_views = 30;
  return options;
}

/// Runs of one method; run i of every method starts at the same view with the same errors.
std::vector<RunOutcome> run_method(const SimulatedObject& object, const Method& method,
                                   const ExperimentOptions& options, const RunProgress& progress) {
  const ReconstructOptions base = free_flyer();
  const VoxelMap map(base.scene_options());
  const Candidates candidates = base.candidate_views();
  std::vector<ExperimentRun> runs;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    ExperimentRun run{&object, base};
    run.options.seed = static_cast<std::uint64_t>(seed);
    Random random(run.options.seed, 99);
    do {
      run.options.initial_view = random.index(static_cast<int>(candidates.views.size()));
    } while (why_infeasible(map, candidates.views[static_cast<std::size_t>(run.options.initial_view)], {}));
    if (method.errs) run.options.positioning_error = Vec3::Constant(sigma);
    if (method.convolves) run.options.convolve = "on";
    runs.push_back(run);
  }
  return run_all(runs, progress);
}

double mean_over_compared_scans(const RunOutcome& outcome) {
  double sum = 0;
  for (std::size_t scan = first_compared; scan <= last_compared; ++scan) sum += 100 * coverage_after(outcome, scan);
  return sum / (last_compared - first_compared + 1);
}

double views_to(double coverage, const RunOutcome& outcome) {
  const auto& curve = outcome.coverage_by_scan;
  const auto reached = std::find_if(curve.begin(), curve.end(), [coverage](double c) { return c >= coverage; });
  return static_cast<double>(reached - curve.begin()) + 1;
}

std::vector<double> each(const std::vector<RunOutcome>& outcomes, const auto& measure) {
  std::vector<double> result;
  for (const RunOutcome& outcome : outcomes) result.push_back(measure(outcome));
  return result;
}

LineSeries curve(const std::string& name, const std::vector<RunOutcome>& outcomes) {
  LineSeries series;
  series.name = name;
  for (std::size_t scan = 1; scan <= scans_shown; ++scan) {
    const Estimate covered =
        estimate(each(outcomes, [scan](const RunOutcome& o) { return 100 * coverage_after(o, scan); }));
    series.x.push_back(static_cast<double>(scan));
    series.y.push_back(covered.mean);
    series.low.push_back(covered.low);
    series.high.push_back(covered.high);
  }
  return series;
}

}  // namespace

std::vector<ExperimentReport::Part> positioning_error_figure(const std::string& name,
                                                             const std::vector<std::string>& objects,
                                                             const ExperimentOptions& options,
                                                             const RunProgress& progress) {
  using Kind = ExperimentTable::Column::Kind;
  const std::optional<std::filesystem::path> folder =
      options.objects ? std::optional<std::filesystem::path>(*options.objects) : std::nullopt;
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
  table.note =
      fmt::format("Coverage: mean over scans {} to {}, differences paired by seed.", first_compared, last_compared);
  table.columns = {{"no error [%]", 2},
                   {"error [%]", 2},
                   {"convolved [%]", 2},
                   {"gain [points]", 2, Kind::difference},
                   {"views to 99 %, no error", 1},
                   {"error", 1},
                   {"convolved", 1}};
  for (const std::string& object_name : objects) {
    const PaperObject object = paper_object(object_name, folder);
    const SimulatedObject simulated(object.mesh, object.size, free_flyer());
    LineChart chart;
    chart.title = fmt::format("{} ({})", object_name, object.source);
    chart.x.label = "scan";
    chart.y.label = "coverage [%]";
    std::vector<std::vector<double>> means, views;
    for (const Method& method : methods) {
      const std::vector<RunOutcome> outcomes = run_method(simulated, method, options, progress);
      chart.series.push_back(curve(method.name, outcomes));
      means.push_back(each(outcomes, mean_over_compared_scans));
      views.push_back(each(outcomes, [](const RunOutcome& o) { return views_to(0.99, o); }));
    }
    figure.plots.emplace_back(chart);
    table.rows.push_back(
        {object_name,
         {estimate(means[0]), estimate(means[1]), estimate(means[2]), paired_difference(means[1], means[2]),
          estimate(views[0]), estimate(views[1]), estimate(views[2])}});
  }
  return {figure, table};
}

}  // namespace vantage
