#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "vantage/core/order_statistics.hpp"
#include "vantage/experiments/error_experiments.hpp"
#include "vantage/experiments/free_flyer.hpp"

namespace vantage {
namespace {

constexpr double goal = 0.99;      // of the visible surface
constexpr double far_off = 0.020;  // metres from which a merged scan counts as a wrong one

bool reaches_goal(const RunOutcome& outcome) { return outcome.number("coverage") >= goal; }

/// How far merged scans are off the truth, metres; without the first ones, which define the frame.
std::vector<double> displacements(const std::vector<RunOutcome>& outcomes) {
  std::vector<double> all;
  for (const RunOutcome& outcome : outcomes) {
    const std::vector<double>& merged = outcome.list("merged");
    const std::vector<double>& error = outcome.list("pose_error");
    for (std::size_t i = 1; i < merged.size(); ++i) {
      if (merged[i] > 0) all.push_back(error[i]);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string in_millimetres(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? "" : fmt::format("{:.2f}", 1000 * sorted_quantile(sorted, share));
}

double seconds_of(const RunOutcome& outcome) {
  double all = 0;
  for (const char* name : {"plan", "registration", "integration"}) {
    const std::vector<double>& times = outcome.time(name);
    all = std::accumulate(times.begin(), times.end(), all);
  }
  return all / 1000;
}

/// Planned scans by the probability with which they were to be registered, and how many were: at once, and within half
/// a voxel of the truth.
ExperimentTable calibration(const std::vector<RunOutcome>& outcomes, double half_voxel) {
  constexpr std::array<double, 7> edges{0, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0 + 1e-9};
  ExperimentTable table;
  table.name = "robustness-registrability";
  table.title = "Probability of being registered: planned and observed";
  table.row_title = "planned probability";
  table.note =
      "Scans after the first of the runs with ICP. Registered: merged at once; and well: less than half a voxel off.";
  table.columns = {{"scans", 0}, {"planned [%]", 1}, {"registered [%]", 1}, {"and well [%]", 1}};
  for (std::size_t bin = 0; bin + 1 < edges.size(); ++bin) {
    std::vector<double> planned, registered, well;
    for (const RunOutcome& outcome : outcomes) {
      const std::vector<double>& probability = outcome.list("register_probability");
      const std::vector<double>& at_once = outcome.list("merged_at_once");
      const std::vector<double>& error = outcome.list("pose_error");
      for (std::size_t i = 1; i < probability.size(); ++i) {
        if (!(probability[i] >= edges[bin] && probability[i] < edges[bin + 1])) continue;
        planned.push_back(100 * probability[i]);
        registered.push_back(100 * at_once[i]);
        well.push_back(at_once[i] > 0 && error[i] < half_voxel ? 100 : 0);
      }
    }
    if (planned.empty()) continue;
    table.rows.push_back(
        {fmt::format("{:g} to {:g}", edges[bin], std::min(1.0, edges[bin + 1])),
         {fmt::format("{}", planned.size()), estimate(planned), estimate(registered), estimate(well)}});
  }
  return table;
}

/// Runs with the same error and registration.
struct RobustnessCase {
  RobustnessOptions::Deviation error;
  std::string registration;
  std::vector<RunGroup> groups;  // one per object

  [[nodiscard]] std::string name() const {
    return fmt::format("{:g} cm, {:g} degrees: {}", 100 * error.position, error.orientation, registration);
  }
};

ExperimentTable::Row row_of(const std::string& name, const std::vector<RunOutcome>& runs,
                            const std::vector<RunOutcome>* with_truth) {
  const auto reached = std::count_if(runs.begin(), runs.end(), reaches_goal);
  const std::vector<double> off = displacements(runs);
  const auto wrong = std::count_if(off.begin(), off.end(), [](double each) { return each > far_off; });
  ExperimentTable::Cell more_views = std::monostate();
  if (with_truth != nullptr) {
    more_views = paired_difference(numbers(*with_truth, "views"), numbers(runs, "views"));
  }
  return {name,
          {fmt::format("{} of {}", reached, runs.size()),
           estimate(each(runs, [](const RunOutcome& o) { return 100 * o.number("coverage"); })),
           estimate(numbers(runs, "views")), more_views, estimate(numbers(runs, "refused_scans")),
           estimate(numbers(runs, "recovered_scans")), in_millimetres(off, 0.5), in_millimetres(off, 0.95),
           in_millimetres(off, 1), fmt::format("{} of {}", wrong, off.size())}};
}

ExperimentTable table_of(const std::string& name, const std::string& title, const std::string& row_title) {
  using Kind = ExperimentTable::Column::Kind;
  ExperimentTable table;
  table.name = name;
  table.title = title;
  table.row_title = row_title;
  table.columns = {
      {"runs to 99 %", 0}, {"coverage [%]", 2}, {"views", 1},       {"more than with truth", 1, Kind::difference},
      {"refused", 2},      {"recovered", 2},    {"median [mm]", 2}, {"95 % [mm]", 2},
      {"worst [mm]", 2},   {"beyond 20 mm", 0}};
  return table;
}

std::vector<RunOutcome> all_of(const std::vector<std::vector<RunOutcome>>& objects) {
  std::vector<RunOutcome> all;
  for (const std::vector<RunOutcome>& object : objects) all.insert(all.end(), object.begin(), object.end());
  return all;
}

struct RobustnessRuns {
  RobustnessOptions options;
  std::vector<std::string> objects;
  std::vector<RobustnessCase> cases;

  [[nodiscard]] std::vector<ExperimentReport::Part> report(const Outcomes& outcomes) const;
};

std::vector<ExperimentReport::Part> RobustnessRuns::report(const Outcomes& outcomes) const {
  ExperimentTable table = table_of("robustness", "Runs of a robot that misses", "error, registration");
  table.note = fmt::format(
      "{} objects, {} seeds each; depth noise {:g} m + {:g} z^2/m; utility {}. Refused: scans per run that could not "
      "be "
      "registered at once; recovered: those of them that were merged later. Displacement: mean over a scan's points, "
      "of "
      "merged scans after the first.",
      objects.size(), options.seeds, options.depth_noise.a, options.depth_noise.b, options.utility);
  ExperimentTable by_object =
      table_of("robustness-objects", "The same object by object", "object, error, registration");
  ExperimentTable times;
  times.name = "robustness-times";
  times.title = "Time of a run";
  times.row_title = table.row_title;
  times.columns = {{"run [s]", 2}, {"registration per scan [ms]", 1}};
  times.content = ExperimentContent::times;
  std::vector<RunOutcome> registered;
  for (const RobustnessCase& each_case : cases) {
    std::vector<RunGroup> groups = each_case.groups;
    const auto is_truth = [&](const RobustnessCase& c) {
      return c.registration == "truth" && c.error.position == each_case.error.position &&
             c.error.orientation == each_case.error.orientation;
    };
    const auto truth = std::find_if(cases.begin(), cases.end(), is_truth);
    const bool compares = truth != cases.end() && each_case.registration != "truth";
    if (compares) groups.insert(groups.end(), truth->groups.begin(), truth->groups.end());
    std::vector<std::vector<RunOutcome>> runs = outcomes.paired(groups);
    std::vector<std::vector<RunOutcome>> with_truth(runs.begin() + static_cast<std::ptrdiff_t>(objects.size()),
                                                    runs.end());
    runs.resize(objects.size());
    const std::vector<RunOutcome> all = all_of(runs), all_with_truth = all_of(with_truth);
    if (each_case.registration == "icp") registered.insert(registered.end(), all.begin(), all.end());
    table.rows.push_back(row_of(each_case.name(), all, compares ? &all_with_truth : nullptr));
    times.rows.push_back(
        {each_case.name(), {estimate(each(all, seconds_of)), estimate(each(all, [](const RunOutcome& o) {
                              const std::vector<double>& list = o.time("registration");
                              return std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size());
                            }))}});
    for (std::size_t i = 0; i < objects.size(); ++i) {
      by_object.rows.push_back(
          row_of(fmt::format("{}, {}", objects[i], each_case.name()), runs[i], compares ? &with_truth[i] : nullptr));
    }
  }
  return {table, by_object, calibration(registered, ReconstructOptions().voxel / 2), times};
}

}  // namespace

Experiment robustness_experiment(const ExperimentOptions& options) {
  Experiment experiment("robustness");
  RobustnessRuns all{options.robustness, {}, {}};
  const auto objects = robustness_objects(options.folder());
  for (const auto& object : objects) all.objects.push_back(object->name());
  for (const RobustnessOptions::Deviation& error : options.robustness.deviations()) {
    for (const std::string& registration : options.robustness.registration_list()) {
      RobustnessCase next{error, registration, {}};
      for (const auto& object : objects) {
        next.groups.push_back(
            experiment.add(runs_with_seeds(fmt::format("{}, {}", object->name(), next.name()), object,
                                           options.robustness.run_options(error, registration),
                                           options.robustness.seeds, {}, options.robustness.first_seed)));
      }
      all.cases.push_back(next);
    }
  }
  experiment.report = [all](const Outcomes& outcomes) { return all.report(outcomes); };
  return experiment;
}

}  // namespace vantage
