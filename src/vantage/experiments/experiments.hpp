#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/runs.hpp"
#include "vantage/io/experiment_report.hpp"

namespace vantage {

struct ExperimentOptions {
  std::optional<std::string> objects;  // folder with meshes of the paper's objects
  int starts = 10;                     // initial views of tables 1, 2 and 4
  int seeds = 12;                      // paired runs of figures 10 and 11

  void validate() const;
};

template <class Field>
void describe(ExperimentOptions& o, Field&& field) {
  field("objects", o.objects, "", "folder with NAME.ply of the paper's objects; built-in objects if not given");
  field("starts", o.starts, "", "initial views that tables 1, 2 and 4 and figure 9 average over");
  field("seeds", o.seeds, "", "paired runs per method of figures 10 and 11");
}

/// The experiments of the paper that can be run, in its order.
[[nodiscard]] std::vector<std::string> experiment_names();

/// Runs one of them. `progress` is told of every finished run. Throws InputError that lists the names for an unknown
/// one.
[[nodiscard]] std::vector<ExperimentReport::Part> run_experiment(const std::string& name,
                                                                 const ExperimentOptions& options,
                                                                 const RunProgress& progress);

}  // namespace vantage
