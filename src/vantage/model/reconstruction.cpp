#include "vantage/model/reconstruction.hpp"

#include <chrono>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Scans that were merged last without bringing anything; refused ones are neither that nor the contrary.
int fruitless_scans(const std::vector<ScanRecord>& scans) {
  const std::vector<std::int64_t> gained = gains(scans);
  int fruitless = 0;
  for (std::size_t i = scans.size(); i-- > 0 && gained[i] == 0;) fruitless += scans[i].merged_after ? 1 : 0;
  return fruitless;
}

}  // namespace

void Budget::validate() const {
  require(max_views >= 1, "max-views = ", max_views, ": must be at least 1");
  require(max_distance > 0, "max-distance = ", max_distance, ": must be positive");
  require(max_time > 0, "max-time = ", max_time, " s: must be positive");
  require(max_fruitless_scans >= 1, "max-fruitless-scans = ", max_fruitless_scans, ": must be at least 1");
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
  if (record.merged || !record.recovered.empty()) planner_.map_changed();
  if (record.merged) {
    planner_.scanned(record.registered, candidate);
  } else {
    planner_.set_aside(candidate, concat("its scan could not be registered: ", record.verdict));
  }
  for (const int number : record.recovered) {
    const ScanRecord& earlier = model.scans[static_cast<std::size_t>(number)];
    planner_.scanned(earlier.registered, earlier.candidate);
  }
  if (learner) learn_from(model, record);
  on_scan(record, scan, model, plan);
  model.scans.push_back(std::move(record));
}

void Reconstruction::learn_from(ObjectModel& model, ScanRecord& record) {
  bool has_learned = teach(*learner, record);
  for (const int number : record.recovered) {
    has_learned = teach(*learner, model.scans[static_cast<std::size_t>(number)]) || has_learned;
  }
  record.learned_error = learner->estimate();
  if (!has_learned) return;
  planner_.believe(learner->prediction());
  registrar_.believe(learner->prediction());
}

std::string Reconstruction::why_stop(const ObjectModel& model, double seconds) const {
  const auto scans = static_cast<int>(model.scans.size());
  if (interrupted()) return "interrupted";
  if (scans >= budget.max_views) return concat("the budget of ", budget.max_views, " views is used up");
  if (model.scans.back().distance >= budget.max_distance) {
    return concat("the budget of ", budget.max_distance, " of travel is used up");
  }
  if (seconds >= budget.max_time) return concat("the budget of ", budget.max_time, " s is used up");
  if (const int fruitless = fruitless_scans(model.scans); fruitless >= budget.max_fruitless_scans)
    return concat(fruitless, " scans in a row brought no new occupied voxel");
  return {};
}

void Reconstruction::run(ObjectModel& model, int initial_candidate) {
  budget.validate();
  explore(model, initial_candidate);
  (void)conclude(model, registrar_, quality);
  on_end(model);
}

void Reconstruction::explore(ObjectModel& model, int initial_candidate) {
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
