#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "vantage/experiments/sweep_run.hpp"

namespace vantage {

/// What came of a run: an outcome, or why there is none.
struct RunResult {
  std::optional<RunOutcome> outcome;
  std::string error;         // empty where there is an outcome
  bool interrupted = false;  // it may yet get an outcome at the next start
};

/// Works on one run in this thread; what it throws becomes the result's error.
[[nodiscard]] RunResult result_of(const SweepRun& run, const Interrupted& interrupted);

/// The threads of this process that work on runs of a sweep, as many as oneTBB grants. One other thread hands out the
/// runs and collects what came of them.
class LocalWorkers {
 public:
  /// Both must outlive the workers.
  LocalWorkers(std::span<const SweepRun> runs, const Interrupted& interrupted);
  /// Ends what is going on as soon as the runs ask whether they are interrupted.
  ~LocalWorkers();
  LocalWorkers(const LocalWorkers&) = delete;
  LocalWorkers& operator=(const LocalWorkers&) = delete;

  /// How many more runs to assign: one per thread that has none, and one in reserve, so that no thread waits while an
  /// outcome is stored.
  [[nodiscard]] std::size_t wanted() const;
  void assign(std::size_t run);
  /// No more runs will come: threads that have nothing to do help those that have.
  void close();

  struct Finished {
    std::size_t run;
    RunResult result;
  };
  /// What has been finished since the last call; waits up to `most` for that, or for a thread without a run.
  [[nodiscard]] std::vector<Finished> finished(std::chrono::milliseconds most);
  /// Closed, and everything assigned has been returned by finished().
  [[nodiscard]] bool done() const;

 private:
  void work();
  void serve();
  [[nodiscard]] std::optional<std::size_t> take();

  std::span<const SweepRun> runs_;
  const Interrupted& interrupted_;
  mutable std::mutex mutex_;
  std::condition_variable assigned_or_closed_, something_happened_;
  std::deque<std::size_t> assigned_;
  std::vector<Finished> finished_;
  std::size_t waiting_ = 0, open_ = 0;  // workers without a run; runs assigned and not yet returned
  bool became_idle_ = false;
  bool closed_ = false, abandoned_ = false;
  std::thread thread_;
};

}  // namespace vantage
