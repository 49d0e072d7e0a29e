#include "vantage/experiments/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/robot/reach.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t start_stream = 99;  // of a seed; the robot's own streams are two per move

}  // namespace

std::vector<std::vector<RunOutcome>> Outcomes::paired(const std::vector<RunGroup>& groups, std::size_t least) const {
  std::vector<std::vector<RunOutcome>> outcomes(groups.size());
  for (const RunGroup& group : groups)
    require(group.count == groups.front().count && group.first + group.count <= results_.size(),
            "paired groups of runs: must have the same length, within the experiment's ", results_.size(), " runs");
  for (std::size_t i = 0; !groups.empty() && i < groups.front().count; ++i) {
    const auto result = [&](const RunGroup& group) -> const RunResult& { return results_[group.first + i]; };
    if (!std::all_of(groups.begin(), groups.end(), [&](const RunGroup& g) { return result(g).outcome.has_value(); }))
      continue;
    for (std::size_t g = 0; g < groups.size(); ++g) outcomes[g].push_back(*result(groups[g]).outcome);
  }
  if (!groups.empty() && outcomes.front().size() < least)
    throw Error(concat(outcomes.front().size(), " of ", groups.front().count, " runs have an outcome: at least ", least,
                       " are needed"));
  return outcomes;
}

RunGroup Experiment::add(std::vector<SweepRun> more) {
  const RunGroup group{runs.size(), more.size()};
  std::move(more.begin(), more.end(), std::back_inserter(runs));
  return group;
}

std::vector<SweepRun> runs_from_starts(const std::string& name, const std::shared_ptr<const SweepObject>& object,
                                       const ReconstructOptions& options, int starts) {
  const auto views = static_cast<int>(options.candidate_views().views.size());
  require(starts >= 1 && starts <= views, "starts = ", starts, ": must be in 1..", views, ", the candidate views");
  std::vector<SweepRun> runs;
  for (int i = 0; i < starts; ++i) {
    ReconstructOptions mine = options;
    mine.initial_view = i * views / starts;
    runs.push_back(reconstruction_run(fmt::format("{}, start {}", name, mine.initial_view), object, mine));
  }
  return runs;
}

std::vector<SweepRun> runs_with_seeds(const std::string& name, const std::shared_ptr<const SweepObject>& object,
                                      const ReconstructOptions& options, int seeds, const ExtraMeasures& extra,
                                      int first_seed) {
  const VoxelMap map(options.scene_options());
  const std::vector<View> views = options.candidate_views().views;
  const ReachOptions reach = options.planner_options().reach;
  require(std::any_of(views.begin(), views.end(), [&](const View& view) { return !why_infeasible(map, view, reach); }),
          name, ": none of the ", views.size(), " candidate views is feasible");
  std::vector<SweepRun> runs;
  for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
    ReconstructOptions mine = options;
    mine.seed = static_cast<std::uint64_t>(seed);
    Random random(mine.seed, start_stream);
    do {
      mine.initial_view = random.index(static_cast<int>(views.size()));
    } while (why_infeasible(map, views[static_cast<std::size_t>(mine.initial_view)], reach));
    runs.push_back(reconstruction_run(fmt::format("{}, seed {}", name, seed), object, mine, extra));
  }
  return runs;
}

}  // namespace vantage
