#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "vantage/experiments/experiment_report.hpp"
#include "vantage/experiments/local_workers.hpp"

// An experiment is a list of runs and a function that makes tables and figures of all outcomes. To add one, write a
// function that returns it and name it in experiments.cpp:
//
//     Experiment finer_candidates(const ExperimentOptions& options) {
//       const auto mug = paper_object("mug", options.folder()).object;
//       ReconstructOptions coarse, fine;
//       fine.candidates = "sphere:320:2";
//       Experiment experiment("finer");
//       const RunGroup few = experiment.add(runs_from_starts("mug, 80 views", mug, coarse, options.starts));
//       const RunGroup many = experiment.add(runs_from_starts("mug, 320 views", mug, fine, options.starts));
//       experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
//         const auto paired = outcomes.paired({few, many});  // without the starts of which a run failed
//         ExperimentTable table{...};
//         table.rows.push_back({"views", {paired_difference(numbers(paired[0], "views"), numbers(paired[1],
//         "views"))}}); return {table};
//       };
//       return experiment;
//     }
//
// The rest comes by itself: all cores, ranks of MPI, runs shared with other experiments, going on after a kill,
// progress, files. Runs that are no reconstructions are a SweepRun of their own (times_table.cpp has some).
namespace vantage {

/// Runs of an experiment that belong together: run i of one group is paired with run i of another.
struct RunGroup {
  std::size_t first = 0, count = 0;
};

/// The results of an experiment's runs.
class Outcomes {
 public:
  explicit Outcomes(std::vector<RunResult> results) : results_(std::move(results)) {}

  /// The outcomes of groups of equal length, without the places at which a run of any of them has none. Throws Error
  /// where fewer than `least` places are left.
  [[nodiscard]] std::vector<std::vector<RunOutcome>> paired(const std::vector<RunGroup>& groups,
                                                            std::size_t least = 1) const;
  [[nodiscard]] std::vector<RunOutcome> of(const RunGroup& group) const { return paired({group}).front(); }

 private:
  std::vector<RunResult> results_;
};

struct Experiment {
  std::string name;
  std::vector<SweepRun> runs;
  std::function<std::vector<ExperimentReport::Part>(const Outcomes&)> report;

  explicit Experiment(std::string its_name) : name(std::move(its_name)) {}
  RunGroup add(std::vector<SweepRun> more);
};

/// The same reconstruction from `starts` initial views, spread evenly over the candidates.
[[nodiscard]] std::vector<SweepRun> runs_from_starts(const std::string& name,
                                                     const std::shared_ptr<const SweepObject>& object,
                                                     const ReconstructOptions& options, int starts);

/// The same reconstruction with `seeds` seeds from `first_seed` on, each from an initial view of its own that is drawn
/// among the feasible candidates by the seed alone, so that methods with the same candidates start alike.
[[nodiscard]] std::vector<SweepRun> runs_with_seeds(const std::string& name,
                                                    const std::shared_ptr<const SweepObject>& object,
                                                    const ReconstructOptions& options, int seeds,
                                                    const ExtraMeasures& extra = {}, int first_seed = 1);

}  // namespace vantage
