#include "vantage/experiments/experiments.hpp"

#include "vantage/core/error.hpp"
#include "vantage/experiments/tables.hpp"

namespace vantage {

void ExperimentOptions::validate() const {
  require(starts >= 1 && starts <= 80, "starts = ", starts, ": must be in 1..80");
  require(seeds >= 2, "seeds = ", seeds, ": must be at least 2");
}

std::vector<std::string> experiment_names() {
  return {"table1", "table2", "table4", "figure9", "figure10", "figure11"};
}

std::vector<ExperimentReport::Part> run_experiment(const std::string& name, const ExperimentOptions& options,
                                                   const RunProgress& progress) {
  options.validate();
  if (name == "table1") return {search_table("exhaustive", options, progress)};
  if (name == "table2") return {search_table("multi-resolution", options, progress)};
  if (name == "table4") return {navigation_table(options, progress)};
  if (name == "figure9") return {gua_figure(options, progress)};
  if (name == "figure10") return positioning_error_figure("figure10", {"sphere", "mug"}, options, progress);
  if (name == "figure11") return positioning_error_figure("figure11", {"sgi_logo"}, options, progress);
  std::string list;
  for (const std::string& each : experiment_names()) list += each + ", ";
  throw InputError(concat("experiment '", name, "' is unknown; must be one of: ", list, "all"));
}

}  // namespace vantage
