#include "vantage/experiments/local_workers.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace vantage {

RunResult result_of(const SweepRun& run, const Interrupted& interrupted) {
  try {
    if (interrupted()) throw RunInterrupted();
    return {run.work(interrupted), "", false};
  } catch (const RunInterrupted& interruption) {
    return {std::nullopt, interruption.what(), true};
  } catch (const std::exception& error) {
    return {std::nullopt, error.what(), false};
  }
}

LocalWorkers::LocalWorkers(std::span<const SweepRun> runs, const Interrupted& interrupted)
    : runs_(runs), interrupted_(interrupted), thread_([this] { work(); }) {}

LocalWorkers::~LocalWorkers() {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = closed_ = true;
    assigned_.clear();
  }
  assigned_or_closed_.notify_all();
  thread_.join();
}

std::size_t LocalWorkers::wanted() const {
  const std::lock_guard lock(mutex_);
  return waiting_ + 1 > assigned_.size() ? waiting_ + 1 - assigned_.size() : 0;
}

void LocalWorkers::assign(std::size_t run) {
  {
    const std::lock_guard lock(mutex_);
    assigned_.push_back(run);
    ++open_;
  }
  assigned_or_closed_.notify_one();
}

void LocalWorkers::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  assigned_or_closed_.notify_all();
}

std::vector<LocalWorkers::Finished> LocalWorkers::finished(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  something_happened_.wait_for(lock, most, [this] { return !finished_.empty() || became_idle_; });
  became_idle_ = false;
  open_ -= finished_.size();
  return std::exchange(finished_, {});
}

bool LocalWorkers::done() const {
  const std::lock_guard lock(mutex_);
  return closed_ && open_ == 0;
}

void LocalWorkers::work() {
  const std::size_t threads = std::min(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
                                       tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  tbb::parallel_for(
      std::size_t{0}, threads, [this](std::size_t) { serve(); }, tbb::simple_partitioner());
}

void LocalWorkers::serve() {
  const Interrupted stop = [this] {
    const std::lock_guard lock(mutex_);
    return abandoned_ || interrupted_();
  };
  while (const std::optional<std::size_t> run = take()) {
    RunResult result;
    // Isolated: a run that waits for its own loops must not take up another run, and so become the last to finish.
    tbb::this_task_arena::isolate([&] { result = result_of(runs_[*run], stop); });
    {
      const std::lock_guard lock(mutex_);
      finished_.push_back({*run, std::move(result)});
    }
    something_happened_.notify_one();
  }
}

std::optional<std::size_t> LocalWorkers::take() {
  std::unique_lock lock(mutex_);
  ++waiting_;
  became_idle_ = true;
  something_happened_.notify_one();
  assigned_or_closed_.wait(lock, [this] { return !assigned_.empty() || closed_; });
  --waiting_;
  if (assigned_.empty()) return std::nullopt;
  const std::size_t run = assigned_.front();
  assigned_.pop_front();
  return run;
}

}  // namespace vantage
