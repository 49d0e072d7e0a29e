#include "vantage/model/reconstruction.hpp"

#include <chrono>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

LabelCounts label_counts(const VoxelMap& map) {
  const auto outside = map.grid().size.cast<std::int64_t>().prod() - map.enclosure().size().cast<std::int64_t>().prod();
  return {map.count(Label::unmarked), map.count(Label::occupied), map.count(Label::empty) - outside,
          map.count(Label::occluded), map.count(Label::occplane)};
}

}  // namespace

void Budget::validate() const {
  require(max_views >= 1, "max-views = ", max_views, ": must be at least 1");
  require(max_distance > 0, "max-distance = ", max_distance, ": must be positive");
  require(max_time > 0, "max-time = ", max_time, " s: must be positive");
  require(max_fruitless_scans >= 1, "max-fruitless-scans = ", max_fruitless_scans, ": must be at least 1");
}

ScanRecord update(ObjectModel& model, const Scan& scan, const View& believed, Registrar& registrar,
                  QualityReference quality) {
  ScanRecord record;
  record.scan = static_cast<int>(model.scans.size());
  record.believed = believed;

  auto start = Clock::now();
  const PointCloud points = points_of(scan);
  const Located located = registrar.locate(model.surface, scan, points, believed);
  record.registered = located.view;
  record.merged = located.accepted;
  record.overlap = located.overlap;
  record.residual = located.residual;
  record.verdict = located.verdict;
  record.detail = located.detail;
  record.pose_covariance = located.covariance;
  record.undetermined_directions = located.undetermined_directions;
  record.timings.registration = seconds_since(start);

  start = Clock::now();
  if (located.accepted) {
    const IntegrationReport report = integrate(model.map, scan, located.view, quality);
    record.new_occupied = report.new_occupied;
    record.taken_back = report.taken_back;
    model.surface.merge(points, located.view.world_from_sensor);
    if (located.surface) model.surface.merge(*located.surface, located.view.world_from_sensor);
  }
  record.labels = label_counts(model.map);
  record.mean_quality = model.map.mean_quality();
  record.timings.integration = seconds_since(start);
  return record;
}

void Reconstruction::scan_and_update(ObjectModel& model, const View& commanded, const Plan* plan, int candidate,
                                     double plan_seconds) {
  const auto start = Clock::now();
  const Scan scan = scan_of(robot_.take_range_image());
  const double scan_seconds = seconds_since(start);
  ScanRecord record = update(model, scan, robot_.view(), registrar_, quality);
  record.timings.plan = plan_seconds;
  record.timings.scan = scan_seconds;
  record.candidate = candidate;
  record.commanded = commanded;
  record.reason = plan != nullptr ? plan->explanation : "the initial view";
  if (plan != nullptr) record.planned = plan->best;
  if (!model.scans.empty()) {
    const ScanRecord& last = model.scans.back();
    record.distance = last.distance + (plan != nullptr ? planner_.distance_of(*plan, last.commanded.position()) : 0);
  }
  if (record.merged) {
    planner_.map_changed();
    planner_.scanned(record.registered, candidate);
  } else {
    planner_.set_aside(candidate, concat("its scan could not be registered: ", record.verdict));
  }
  if (learner && teach(*learner, record)) {
    planner_.believe(learner->prediction());
    registrar_.believe(learner->prediction());
  }
  on_scan(record, scan, model, plan);
  model.scans.push_back(std::move(record));
}

bool teach(ErrorLearner& learner, ScanRecord& record) {
  const bool is_lesson = record.merged && record.scan > 0;
  if (is_lesson) learner.add(record.commanded, record.registered);
  record.learned_error = learner.estimate();
  return is_lesson;
}

std::string Reconstruction::why_stop(const ObjectModel& model, double seconds) const {
  const auto scans = static_cast<int>(model.scans.size());
  if (interrupted()) return "interrupted";
  if (scans >= budget.max_views) return concat("the budget of ", budget.max_views, " views is used up");
  if (model.scans.back().distance >= budget.max_distance) {
    return concat("the budget of ", budget.max_distance, " of travel is used up");
  }
  if (seconds >= budget.max_time) return concat("the budget of ", budget.max_time, " s is used up");
  int fruitless = 0;
  while (fruitless < scans && model.scans[static_cast<std::size_t>(scans - 1 - fruitless)].new_occupied == 0) {
    ++fruitless;
  }
  if (fruitless >= budget.max_fruitless_scans)
    return concat(fruitless, " scans in a row brought no new occupied voxel");
  return {};
}

void Reconstruction::run(ObjectModel& model, int initial_candidate) {
  budget.validate();
  const auto start = Clock::now();
  const auto& candidates = planner_.candidates().views;
  require(initial_candidate >= 0 && initial_candidate < static_cast<int>(candidates.size()),
          "initial-view = ", initial_candidate, ": must be one of the candidates 0 .. ", candidates.size() - 1);
  const View& initial = candidates[static_cast<std::size_t>(initial_candidate)];
  if (const auto reason = planner_.begin_at(model.map, initial_candidate)) {
    throw InputError(concat("initial-view = ", initial_candidate, ": not feasible, ", *reason));
  }
  require(robot_.move_to(initial), "initial-view = ", initial_candidate, ": the robot cannot reach it");
  scan_and_update(model, initial, nullptr, initial_candidate, 0);
  while ((stop_reason_ = why_stop(model, seconds_since(start))).empty()) {
    const auto plan_start = Clock::now();
    std::optional<Plan> plan = planner_.next_best_view(model.map, robot_.view());
    const double plan_seconds = seconds_since(plan_start);
    if (!plan) {
      stop_reason_ = planner_.why_finished();
      return;
    }
    on_plan(*plan);
    while (plan && !(plan->move.possible() ? robot_.follow(plan->move) : robot_.move_to(plan->best.view))) {
      plan = planner_.next_in_rank(model.map, robot_.view(), *std::move(plan), "the robot could not reach it");
      if (plan) on_plan(*plan);
    }
    if (!plan) continue;
    planner_.arrived(*plan);
    scan_and_update(model, plan->best.view, &*plan, plan->best.candidate, plan_seconds);
  }
}

}  // namespace vantage
