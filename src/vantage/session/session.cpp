#include "vantage/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/runs/run_folder.hpp"
#include "vantage/session/sealed_file.hpp"

namespace vantage {
namespace {

/// Why there is nothing to plan on, or empty.
std::string why_not_yet(const SessionState& state) {
  if (state.scans.empty()) return "there is no scan yet; add one";
  if (!state.box_was_seen) {
    return fmt::format(
        "none of the {} scans has a point in the box; `vantage doctor` tells whether poses, units or the box are wrong",
        state.scans.size());
  }
  return {};
}

}  // namespace

void Session::create(const std::filesystem::path& folder, const ScanPlanningOptions& options) {
  SessionFolder::create(folder, options);
}

Session::Session(const std::filesystem::path& folder, OnScan on_scan)
    : folder_(folder), on_scan_(std::move(on_scan)), model_(std::make_unique<SessionModel>(folder_.options())) {
  replay();
}

void Session::replay() {
  const std::vector<int> numbers = folder_.scans();
  for (const int number : numbers) {
    std::optional<Waiting> waiting;
    try {
      waiting = Waiting{number, folder_.read(number)};
    } catch (const InputError& error) {
      folder_.set_aside(number, error.what());
      continue;
    } catch (const std::exception& error) {
      leave_out(number, error.what());
    }
    const auto same = waiting ? number_of_key_.find(waiting->scan.key) : number_of_key_.end();
    if (same != number_of_key_.end()) {
      folder_.pass_over(number, fmt::format("it has the key of scan {}", same->second));
      continue;
    }
    ++stored_;
    if (waiting) note_identity(*waiting);
    if (waiting) integrate_one(*waiting, folder_.located(number));
  }
  skipped_ = folder_.skipped();
  removed_ = folder_.removed();
  publish();
}

int Session::store(SessionScan scan) {
  scan.validate();
  // Another key would not be known again. Those that are stored already may be of 0.1, which took any.
  require_plain_text(scan.key, fmt::format("scan {}: its key", scan.name));
  const std::lock_guard storing(storing_);
  if (const auto found = number_of_key_.find(scan.key); found != number_of_key_.end()) return found->second;
  const int number = folder_.store(scan);
  waiting_.push_back({number, std::move(scan)});
  note_identity(waiting_.back());
  const std::lock_guard looking(looking_);
  ++stored_;
  return number;
}

void Session::note_identity(const Waiting& waiting) {
  if (!waiting.scan.key.empty()) number_of_key_.emplace(waiting.scan.key, waiting.number);
  numbers_of_content_.emplace(checksum_of(measured_bytes(waiting.scan)), waiting.number);
}

void Session::integrate_one(const Waiting& waiting, const std::optional<Located>& known) {
  try {
    model_is_whole_ = false;
    const Located found = model_->add(waiting.number, waiting.scan, known);
    model_is_whole_ = true;
    if (!known) store_located(waiting.number, found);
    if (state()) publish();
  } catch (const std::exception& error) {
    leave_out(waiting.number, error.what());
    model_is_whole_ = false;
    merge_again(model_->numbers());
    return;
  }
  tell_follower(*model_);
}

void Session::tell_follower(const SessionModel& model) {
  try {
    on_scan_(model);
  } catch (const std::exception& error) {
    warn(fmt::format("scan {} was merged, but whoever follows the session did not hear of it: {}",
                     model.numbers().back(), error.what()));
  }
}

void Session::store_located(int number, const Located& found) {
  try {
    folder_.store_located(number, found);
  } catch (const Error& error) {
    warn(error.what());  // the scan itself is safe, and registration will find the same again
  }
}

void Session::warn(const std::string& what) {
  constexpr std::size_t most_warnings = 100;
  const std::lock_guard looking(looking_);
  if (warnings_.size() < most_warnings) warnings_.push_back(what);
}

void Session::leave_out(int number, const std::string& why) {
  const std::lock_guard looking(looking_);
  left_out_[number] = why;
}

void Session::publish() {
  auto now = std::make_shared<const SessionState>(model_->state());
  const std::lock_guard looking(looking_);
  state_ = std::move(now);
}

std::optional<Session::Waiting> Session::next_waiting(int up_to) {
  const std::lock_guard storing(storing_);
  if (waiting_.empty() || waiting_.front().number > up_to) return std::nullopt;
  Waiting waiting = std::move(waiting_.front());
  waiting_.pop_front();
  return waiting;
}

ScanRecord Session::integrate(int number) {
  while (true) {
    // One scan at a time, so that whoever waits for an earlier one does not wait for all.
    const std::lock_guard merging(merging_);
    if (!model_is_whole_) merge_again(model_->numbers());
    const std::optional<Waiting> waiting = next_waiting(number);
    if (!waiting) break;
    integrate_one(*waiting, std::nullopt);
  }
  const auto now = state();
  const auto found = std::find(now->numbers.begin(), now->numbers.end(), number);
  if (found != now->numbers.end()) return now->scans[static_cast<std::size_t>(found - now->numbers.begin())];
  const std::lock_guard looking(looking_);
  require(left_out_.contains(number), "scan ", number, ": is not in the session");
  throw Error(fmt::format("scan {} is safe on disk but could not be merged: {}; opening the session tries it again",
                          number, left_out_.at(number)));
}

std::shared_ptr<const SessionState> Session::state() const {
  const std::lock_guard looking(looking_);
  return state_;
}

SessionPlan Session::next() {
  const std::lock_guard planning(planning_);
  SessionPlan plan;
  std::map<int, std::string> skipped;
  {
    const std::lock_guard looking(looking_);
    plan.state = state_;
    skipped = skipped_;
  }
  if (plan_ && plan_->state == plan.state && skipped_of_plan_ == skipped) return *plan_;
  plan.why_finished = why_not_yet(*plan.state);
  if (plan.why_finished.empty()) {
    Planner planner = session_planner(options(), *plan.state, skipped);
    plan.plan = planner.next_best_view(plan.state->map, plan.state->current);
    plan.why_finished = planner.why_finished();
  }
  plan_ = plan;
  skipped_of_plan_ = std::move(skipped);
  return plan;
}

void Session::skip(int candidate, const std::string& reason) {
  require(!reason.empty(), "reason: must say why candidate ", candidate, " is skipped");
  require_plain_text(reason, "reason");
  change_skipped(candidate, reason);
}

void Session::unskip(int candidate) { change_skipped(candidate, std::nullopt); }

void Session::change_skipped(int candidate, const std::optional<std::string>& reason) {
  require(candidate >= 0 && candidate < options().scene.views, "candidate = ", candidate,
          ": must be one of the views 0 .. ", options().scene.views - 1);
  const std::lock_guard storing(storing_);
  std::map<int, std::string> skipped = folder_.skipped();
  require(reason || skipped.count(candidate) == 1, "candidate ", candidate, ": was not skipped");
  if (reason) {
    skipped[candidate] = *reason;
  } else {
    skipped.erase(candidate);
  }
  folder_.store_skipped(skipped);
  const std::lock_guard looking(looking_);
  skipped_ = std::move(skipped);
}

SessionStatus Session::status() {
  SessionStatus status;
  const std::lock_guard looking(looking_);
  status.stored = stored_;
  status.state = state_;
  status.integrated = state_->scans.size();
  status.merged = static_cast<std::size_t>(std::count_if(state_->scans.begin(), state_->scans.end(),
                                                         [](const ScanRecord& record) { return record.merged; }));
  status.skipped = skipped_;
  status.removed = removed_;
  status.left_out = left_out_;
  status.dropped = folder_.dropped();
  status.warnings = warnings_;
  return status;
}

PointCloud Session::cloud() {
  const std::lock_guard merging(merging_);
  return object_cloud(model_->model());
}

MeasuredMesh Session::mesh() {
  const std::lock_guard meshing(meshing_);
  const auto now = state();
  std::vector<FusedScan> wanted;
  for (std::size_t i = 0; i < now->numbers.size(); ++i) {
    const ScanRecord& record = now->scans[i];
    wanted.push_back({now->numbers[i], record.merged, record.registered.world_from_sensor.matrix()});
  }
  // Scans may have come in later, and their poses may have been improved: then all are fused again.
  const bool goes_on =
      surface_ && fused_.size() <= wanted.size() && std::equal(fused_.begin(), fused_.end(), wanted.begin());
  if (!goes_on) {
    surface_.emplace(now->map.grid().box(now->map.enclosure()));
    fused_.clear();
  }
  for (std::size_t i = fused_.size(); i < wanted.size(); ++i) {
    fused_.push_back(wanted[i]);
    const ScanRecord& record = now->scans[i];
    if (!record.merged) continue;
    surface_->fuse(folder_.read(wanted[i].number).scan, record.registered, std::nullopt, record.residual);
  }
  return surface_->mesh();
}

}  // namespace vantage
