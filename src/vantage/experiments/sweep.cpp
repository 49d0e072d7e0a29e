#include "vantage/experiments/sweep.hpp"

#include <chrono>
#include <deque>
#include <map>

#include "vantage/core/error.hpp"
#include "vantage/experiments/sweep_messages.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;
using MessageKind = SweepMessage::Kind;

constexpr std::chrono::milliseconds poll_alone{200}, poll_with_others{2};
constexpr double seconds_between_reports = 1;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Everything that rank 0 knows of a sweep while it goes on.
class Dispatcher {
 public:
  Dispatcher(std::span<const SweepRun> runs, const RunStore& store, Ranks& ranks, const SweepControl& control)
      : runs_(runs),
        store_(store),
        ranks_(ranks),
        control_(control),
        digest_(digest_of(runs)),
        results_(runs.size()),
        first_equal_(runs.size()),
        others_(static_cast<std::size_t>(ranks.size() - 1)) {
    find_what_is_left();
  }

  std::vector<RunResult> run() {
    report();
    work_together();
    for (const std::size_t run : alone_) note(run, result_of(runs_[run], control_.interrupted));
    for (std::size_t i = 0; i < runs_.size(); ++i) results_[i] = results_[first_equal_[i]];
    return std::move(results_);
  }

 private:
  void work_together() {
    LocalWorkers workers(runs_, control_.interrupted);
    while (progress_.remaining > alone_.size() || said_bye_ < others_) {
      if (control_.interrupted()) give_up_pending();
      while (workers.wanted() > 0 && !pending_.empty()) workers.assign(next());
      if (pending_.empty()) {
        workers.close();
        tell_all_to_stop();
      }
      for (LocalWorkers::Finished& each : workers.finished(others_ > 0 ? poll_with_others : poll_alone))
        note(each.run, std::move(each.result));
      while (const auto message = ranks_.receive()) handle(*message);
      if (seconds_since(reported_) >= seconds_between_reports) report();
    }
  }

  void find_what_is_left() {
    std::map<std::string, std::size_t> seen;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      first_equal_[i] = seen.emplace(runs_[i].configuration, i).first->second;
      if (first_equal_[i] != i) continue;
      if (std::optional<RunOutcome> stored = store_.load(runs_[i])) {
        results_[i].outcome = std::move(stored);
        ++progress_.stored;
      } else {
        (runs_[i].place == SweepRun::Place::alone ? alone_ : pending_).push_back(i);
      }
    }
    progress_.remaining = pending_.size() + alone_.size();
  }

  std::size_t next() {
    const std::size_t run = pending_.front();
    pending_.pop_front();
    return run;
  }

  void give_up_pending() {
    for (const std::size_t run : pending_) results_[run] = {std::nullopt, "interrupted", true};
    progress_.remaining -= pending_.size();
    pending_.clear();
  }

  void note(std::size_t run, RunResult result) {
    if (result.outcome) {
      store_.save(runs_[run], *result.outcome);
      ++progress_.done;
    } else if (!result.interrupted) {
      store_.save_failure(runs_[run], result.error);
      ++progress_.failed;
    }
    results_[run] = std::move(result);
    --progress_.remaining;
    report();
  }

  void handle(const Ranks::Message& received) {
    SweepMessage message = decode(received.bytes);
    switch (message.kind) {
      case MessageKind::want:
        require(message.text == digest_, "rank ", received.from,
                " has another list of runs than rank 0: start all ranks with the same program, options and objects");
        // Those that ask when nothing is left have been told to stop already, or will be.
        if (!pending_.empty()) ranks_.send(received.from, encode({MessageKind::run, next(), {}, ""}));
        break;
      case MessageKind::result:
        require(message.run < runs_.size(), "rank ", received.from, " sent run ", message.run, ": there are ",
                runs_.size());
        note(message.run, std::move(message.result));
        break;
      case MessageKind::bye:
        ++said_bye_;
        break;
      default:
        throw Error(concat("rank ", received.from, " sent what only rank 0 may say"));
    }
  }

  void tell_all_to_stop() {
    if (told_to_stop_) return;
    told_to_stop_ = true;
    for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, encode({MessageKind::stop, 0, {}, ""}));
  }

  void report() {
    reported_ = Clock::now();
    progress_.seconds = seconds_since(started_);
    const std::size_t finished = progress_.done + progress_.failed;
    progress_.seconds_left =
        finished == 0 ? 0
                      : progress_.seconds * static_cast<double>(progress_.remaining) / static_cast<double>(finished);
    control_.progress(progress_);
  }

  std::span<const SweepRun> runs_;
  const RunStore& store_;
  Ranks& ranks_;
  const SweepControl& control_;
  std::string digest_;
  std::vector<RunResult> results_;
  std::vector<std::size_t> first_equal_;  // the first run with the same configuration
  std::deque<std::size_t> pending_, alone_;
  std::size_t others_, said_bye_ = 0;
  bool told_to_stop_ = false;
  SweepProgress progress_;
  Clock::time_point started_ = Clock::now(), reported_ = started_;
};

}  // namespace

std::vector<RunResult> run_sweep(std::span<const SweepRun> runs, const RunStore& store, Ranks& ranks,
                                 const SweepControl& control) {
  return Dispatcher(runs, store, ranks, control).run();
}

void help_sweep(std::span<const SweepRun> runs, Ranks& ranks, const SweepControl& control) {
  const std::string digest = digest_of(runs);
  LocalWorkers workers(runs, control.interrupted);
  std::size_t asked = 0;  // wants without an answer
  while (!workers.done()) {
    for (; asked < workers.wanted(); ++asked) ranks.send(0, encode({MessageKind::want, 0, {}, digest}));
    while (const auto message = ranks.receive()) {
      const SweepMessage order = decode(message->bytes);
      if (order.kind == MessageKind::run) {
        --asked;
        workers.assign(order.run);
      } else if (order.kind == MessageKind::stop) {
        workers.close();
      }
    }
    for (LocalWorkers::Finished& each : workers.finished(poll_with_others))
      ranks.send(0, encode({MessageKind::result, each.run, std::move(each.result), ""}));
  }
  ranks.send(0, encode({MessageKind::bye, 0, {}, ""}));
}

}  // namespace vantage
