#include "vantage/experiments/experiments.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/experiments/compare.hpp"
#include "vantage/experiments/error_experiments.hpp"
#include "vantage/experiments/tables.hpp"
#include "vantage/options/options.hpp"

namespace vantage {
namespace {

using Maker = Experiment (*)(const ExperimentOptions&);

struct Named {
  const char* name;
  Maker make;
  bool in_all;  // a table or figure of the paper
};

constexpr Named makers[] = {{"table1", exhaustive_table, true},
                            {"table2", multi_resolution_table, true},
                            {"table3", times_table, true},
                            {"table4", navigation_table, true},
                            {"figure7", utility_surface_figure, true},
                            {"figure9", gua_figure, true},
                            {"figure9-readings", gua_readings_table, false},
                            {"figure10", simple_objects_figure, true},
                            {"figure11", logo_figure, true},
                            {"figure11-readings", convolution_readings_table, false},
                            {"orientation", orientation_experiment, false},
                            {"learning", learning_experiment, false},
                            {"registration", registration_experiment, false},
                            {"robustness", robustness_experiment, false},
                            {"compare", comparison, false}};

}  // namespace

void ExperimentOptions::validate() const {
  require(starts >= 2 && starts <= 80, "starts = ", starts, ": must be in 2..80, the candidate views of the tables");
  require(seeds >= 2 && seeds <= 10'000, "seeds = ", seeds, ": must be in 2..10000");
  require(!objects || std::filesystem::is_directory(*objects), "objects = '", objects.value_or(""),
          "': must be a folder of meshes NAME.ply");
  compare.validate();
  robustness.validate();
}

std::optional<std::filesystem::path> ExperimentOptions::folder() const {
  if (!objects) return std::nullopt;
  return std::filesystem::path(*objects);
}

std::vector<std::string> experiment_names() {
  std::vector<std::string> names;
  for (const Named& each : makers) names.emplace_back(each.name);
  return names;
}

std::vector<Experiment> make_experiments(const std::string& name, const ExperimentOptions& options) {
  options.validate();
  std::vector<Experiment> experiments;
  for (const Named& each : makers)
    if (name == each.name || (name == "all" && each.in_all)) experiments.push_back(each.make(options));
  if (!experiments.empty()) return experiments;
  std::string list;
  for (const std::string& each : experiment_names()) list += each + ", ";
  const std::string nearest = nearest_name(name, experiment_names());
  throw InputError(concat("experiment '", name, "' is unknown; must be one of: ", list, "all",
                          nearest.empty() ? "" : concat("; did you mean '", nearest, "'?")));
}

std::vector<SweepRun> runs_of(const std::vector<Experiment>& experiments) {
  std::vector<SweepRun> runs;
  for (const Experiment& each : experiments) runs.insert(runs.end(), each.runs.begin(), each.runs.end());
  return runs;
}

std::vector<ExperimentReport::Part> report_parts(const std::vector<Experiment>& experiments,
                                                 const std::vector<RunResult>& results) {
  std::vector<ExperimentReport::Part> parts;
  ExperimentTable failures;
  failures.name = "failures";
  failures.title = "What failed";
  failures.row_title = "run";
  failures.columns = {{"error"}};
  std::size_t first = 0;
  for (const Experiment& experiment : experiments) {
    require(first + experiment.runs.size() <= results.size(), "experiments: ", results.size(),
            " results are fewer than there are runs");
    const auto begin = results.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<RunResult> mine(begin, begin + static_cast<std::ptrdiff_t>(experiment.runs.size()));
    first += mine.size();
    for (std::size_t i = 0; i < mine.size(); ++i)
      if (!mine[i].outcome)
        failures.rows.push_back({concat(experiment.name, ": ", experiment.runs[i].name), {mine[i].error}});
    try {
      for (ExperimentReport::Part& part : experiment.report(Outcomes(mine))) parts.push_back(std::move(part));
    } catch (const Error& error) {
      failures.rows.push_back({experiment.name, {concat("no report: ", error.what())}});
    }
  }
  if (!failures.rows.empty()) parts.emplace_back(failures);
  return parts;
}

}  // namespace vantage
