#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/tables.hpp"
#include "vantage/simulation/simulated_robot.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int maps = 5;             // states of the map that plans are timed on: after 1 .. 5 scans
constexpr int repetitions = 5;      // of each plan
constexpr double scene_side = 4.1;  // metres

/// A row of table 3 and its times in seconds.
struct Row {
  int scene, enclosure;  // voxels per side
  int views;
  double published;                                           // multi-resolution
  std::optional<double> published_exhaustive = std::nullopt;  // section 8.2.2
};

constexpr Row rows[] = {{85, 23, 80, 1.89},    {85, 23, 320, 4.08},    {85, 23, 1280, 17.36},
                        {138, 37, 80, 4.96},   {138, 37, 320, 7.80},   {138, 37, 1280, 34.80, 1247},
                        {405, 109, 80, 85.40}, {405, 109, 320, 96.00}, {405, 109, 1280, 386.96}};

ReconstructOptions scene_of(const Row& row) {
  ReconstructOptions options;
  options.voxel = scene_side / row.scene;
  options.scene = Index3::Constant(row.scene);
  options.enclosure = Index3::Constant(row.enclosure);
  options.candidates = fmt::format("sphere:{}:2", row.views);
  return options;
}

struct TimedPlan {
  std::optional<Plan> plan;
  double milliseconds;
};

/// The least time of several repetitions is what the work takes; more is what else the machine had to do.
TimedPlan timed_plan(const std::string& search, const ReconstructOptions& options, const VoxelMap& map,
                     const View& current) {
  ReconstructOptions mine = options;
  mine.search = search;
  Planner planner(mine.candidate_views(), mine.range_camera(), mine.planner_options());
  TimedPlan timed{std::nullopt, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < repetitions; ++i) {
    const auto start = Clock::now();
    timed.plan = planner.next_best_view(map, current);
    timed.milliseconds =
        std::min(timed.milliseconds, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return timed;
}

/// Both searches plan on the same maps; the robot goes where the multi-resolution search says, until nothing is left.
RunOutcome plan_both_ways(const SweepObject& object, const ReconstructOptions& options) {
  const std::shared_ptr<const RangeScanner> scanner = object.scanner(options);
  SimulatedRobot robot(*scanner, options.range_camera(), {}, options.seed);
  ObjectModel model(options.scene_options(), options.point_spacing());
  TrustingRegistrar registrar;
  View next = options.candidate_views().views.front();
  RunOutcome outcome;
  for (int scan = 0; scan < maps; ++scan) {
    require(robot.move_to(next), "the robot cannot reach its next view");
    model.scans.push_back(update(model, scan_of(robot.take_range_image()), robot.view(), registrar));
    const TimedPlan all = timed_plan("exhaustive", options, model.map, robot.view());
    const TimedPlan some = timed_plan("multi-resolution", options, model.map, robot.view());
    if (!all.plan || !some.plan) break;
    outcome.times["exhaustive"].push_back(all.milliseconds);
    outcome.times["multi-resolution"].push_back(some.milliseconds);
    outcome.lists["exhaustive"].push_back(all.plan->best.candidate);
    outcome.lists["multi-resolution"].push_back(some.plan->best.candidate);
    next = some.plan->best.view;
  }
  return outcome;
}

SweepRun timing_run(const PaperObject& object, const Row& row) {
  const ReconstructOptions options = scene_of(row);
  options.validate();
  const nlohmann::ordered_json configuration{{"kind", "plan times"},
                                             {"object", object.object->name()},
                                             {"mesh", object.object->digest()},
                                             {"voxel", options.voxel},
                                             {"scene", row.scene},
                                             {"enclosure", row.enclosure},
                                             {"candidates", options.candidates},
                                             {"maps", maps},
                                             {"repetitions", repetitions}};
  SweepRun run{fmt::format("table3, {} voxels, {} views", row.scene, row.views), configuration.dump(),
               [object, options](const Interrupted&) { return plan_both_ways(*object.object, options); }};
  run.place = SweepRun::Place::alone;
  return run;
}

ExperimentTable::Row filled_row(const Row& row, const RunOutcome& outcome) {
  const std::vector<double>&fast = outcome.time("multi-resolution"), &all = outcome.time("exhaustive");
  Estimate multi_resolution = estimate(fast), exhaustive = estimate(all);
  multi_resolution.published = 1000 * row.published;
  if (row.published_exhaustive) exhaustive.published = 1000 * *row.published_exhaustive;
  std::vector<double> ratio;
  for (std::size_t i = 0; i < fast.size(); ++i) ratio.push_back(all[i] / fast[i]);
  Estimate saved = estimate(ratio);
  if (row.published_exhaustive) saved.published = *row.published_exhaustive / row.published;
  return {fmt::format("{0}³ voxels, enclosure {1}³, {2} views", row.scene, row.enclosure, row.views),
          {multi_resolution, exhaustive, saved}};
}

}  // namespace

Experiment times_table(const ExperimentOptions& options) {
  const PaperObject mug = paper_object("mug", options.folder());
  Experiment experiment("table3");
  for (const Row& row : rows) (void)experiment.add({timing_run(mug, row)});
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable table;
    table.name = "table3";
    table.title = "Table 3: time of one plan";
    table.note = fmt::format(
        "Wall-clock times of this machine on all its cores, nothing else running: they differ from start to start. The "
        "{}, means over the plans after the first {} scans, each the least of {} repetitions; exhaustive: the sensor's "
        "own 320×320 rays. The paper's "
        "times "
        "are "
        "those of its authors' laptop.",
        mug.title(), maps, repetitions);
    table.row_title = "scene and candidates";
    table.columns = {{"multi-resolution [ms]", 2}, {"exhaustive [ms]", 2}, {"exhaustive / multi-resolution", 1}};
    table.content = ExperimentContent::times;
    std::size_t k = 0;
    for (const Row& row : rows) table.rows.push_back(filled_row(row, outcomes.of({k++, 1}).front()));
    return {table};
  };
  return experiment;
}

}  // namespace vantage
