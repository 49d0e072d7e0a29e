#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/compare_options.hpp"
#include "vantage/experiments/experiment.hpp"
#include "vantage/experiments/robustness_options.hpp"
#include "vantage/experiments/sweep.hpp"

namespace vantage {

struct ExperimentOptions {
  std::optional<std::string> objects;  // folder with meshes of the paper's objects
  int starts = 10;                     // initial views of tables 1, 2 and 4
  int seeds = 24;                      // paired runs of figures 10 and 11
  CompareOptions compare = {};
  RobustnessOptions robustness = {};

  void validate() const;
  [[nodiscard]] std::optional<std::filesystem::path> folder() const;
};

template <class Field>
void describe(ExperimentOptions& o, Field&& field) {
  field("objects", o.objects, "",
        "folder with NAME.ply of the paper's objects (of robustness: or any others); built-in objects if not given");
  field("starts", o.starts, "", "initial views that tables 1, 2 and 4 average over; figure 9 takes at least 20");
  field("seeds", o.seeds, "", "paired runs per method of figures 10 and 11");
  describe(o.compare, field);
  describe(o.robustness, field);
}

/// The experiments that can be run, in the paper's order.
[[nodiscard]] std::vector<std::string> experiment_names();

/// The experiments that `name` stands for: one, or with `all` the paper's tables and figures. Throws InputError that
/// lists the names for an unknown one, and where an option is wrong.
[[nodiscard]] std::vector<Experiment> make_experiments(const std::string& name, const ExperimentOptions& options);

/// All runs of the experiments in one list.
[[nodiscard]] std::vector<SweepRun> runs_of(const std::vector<Experiment>& experiments);

/// Tables and figures of all experiments from the results of runs_of(). Runs that failed are listed in a table of their
/// own, `failures`, and experiments that too few runs are left of are named there too.
[[nodiscard]] std::vector<ExperimentReport::Part> report_parts(const std::vector<Experiment>& experiments,
                                                               const std::vector<RunResult>& results);

}  // namespace vantage
