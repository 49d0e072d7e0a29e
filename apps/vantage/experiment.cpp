#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "cli_options.hpp"
#include "commands.hpp"
#include "executable_digest.hpp"
#include "interrupt.hpp"
#include "notes.hpp"
#include "program_options.hpp"
#include "program_ranks.hpp"
#include "vantage/core/error.hpp"
#include "vantage/experiments/experiments.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage::app {
namespace {

struct ExperimentRequest {
  std::string name;
  std::string out = "runs/experiments";
  bool overwrite = false;
  ExperimentOptions options;
  ProgramOptions program;
};

std::string span_of_time(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  return fmt::format("{:.0f} min", seconds / 60);
}

/// One line that changes on a terminal; in a file, where lines stay, one a minute and a last one.
class ProgressLine {
 public:
  void operator()(const SweepProgress& progress) {
    const bool is_due = progress.seconds >= next_ || progress.remaining == 0;
    if (!is_terminal_ && !is_due) return;
    next_ = progress.seconds + 60;
    const std::size_t finished = progress.done + progress.failed;
    print_note("{}{} stored, {} done, {} failed, {} remaining, {} left{}", is_terminal_ ? "\r" : "", progress.stored,
               progress.done, progress.failed, progress.remaining,
               finished == 0 ? "? s" : span_of_time(progress.seconds_left), is_terminal_ ? "      " : "\n");
  }
  void end() const {
    if (is_terminal_) print_note("\n");
  }

 private:
  bool is_terminal_ = isatty(STDERR_FILENO) != 0;
  double next_ = 0;  // seconds since the sweep began
};

void write_part(const std::filesystem::path& folder, const ExperimentReport::Part& part) {
  std::visit([&folder](const auto& p) { write_file_atomically(folder / (p.name + ".csv"), csv(p)); }, part);
}

/// How many of the runs have no outcome although nobody interrupted them.
std::size_t failures_in(const std::vector<RunResult>& results) {
  std::size_t failed = 0;
  for (const RunResult& result : results) failed += result.outcome || result.interrupted ? 0 : 1;
  return failed;
}

ExperimentReport write_report(const ExperimentRequest& request, const std::vector<Experiment>& experiments,
                              const std::vector<RunResult>& results) {
  const std::filesystem::path folder(request.out);
  ExperimentReport report;
  report.title = request.name == "all" ? "The paper's experiments" : request.name;
  report.program = fmt::format("vantage {}", VANTAGE_VERSION);
  report.parts = report_parts(experiments, results);
  for (const ExperimentReport::Part& part : report.parts) write_part(folder, part);
  // What the clock said goes into files of its own: the others are the same whenever the sweep is repeated.
  const ExperimentReport outcomes = only(report, ExperimentContent::results);
  const ExperimentReport times = only(report, ExperimentContent::times);
  write_file_atomically(folder / "report.html", experiment_page(outcomes.parts.empty() ? times : outcomes));
  if (!outcomes.parts.empty()) write_file_atomically(folder / "print.html", html(outcomes));
  write_file_atomically(folder / "report.json", json(outcomes).dump(2) + "\n");
  if (!times.parts.empty()) {
    write_file_atomically(folder / "timings.html", experiment_page(times));
    write_file_atomically(folder / "timings.json", json(times).dump(2) + "\n");
  }
  return report;
}

/// The results on rank 0, nothing on the others.
std::optional<std::vector<RunResult>> sweep(const ExperimentRequest& request, std::span<const SweepRun> runs,
                                            Ranks& ranks) {
  SweepControl control;
  control.interrupted = was_interrupted;
  try {
    if (ranks.rank() != 0) {
      help_sweep(runs, ranks, control);
      return std::nullopt;
    }
    ProgressLine line;
    if (!request.program.quiet) control.progress = std::ref(line);
    const RunStore store(request.out, fmt::format("vantage {} {}", VANTAGE_VERSION, executable_digest()),
                         request.overwrite ? ForeignFiles::overwrite : ForeignFiles::refuse);
    std::vector<RunResult> results = run_sweep(runs, store, ranks, control);
    if (!request.program.quiet) line.end();
    return results;
  } catch (const std::exception& error) {
    if (ranks.size() > 1) print_note("vantage, rank {}: {}\n", ranks.rank(), error.what());
    ranks.give_up();
    throw;
  }
}

void experiment(const ExperimentRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  const std::vector<Experiment> experiments = make_experiments(request.name, request.options);
  const std::vector<SweepRun> runs = runs_of(experiments);
  catch_interrupts();
  const std::unique_ptr<Ranks> ranks = program_ranks();
  const auto results = sweep(request, runs, *ranks);
  if (!results) return;
  if (was_interrupted())
    throw Error(fmt::format("interrupted; what is finished is kept in {}, the same command goes on", request.out));

  const ExperimentReport report = write_report(request, experiments, *results);
  if (request.program.json) {
    fmt::print("{}\n", json(report).dump(2));
  } else {
    fmt::print("written to {}; open report.html there\n", request.out);
  }
  if (const std::size_t failed = failures_in(*results); failed > 0)
    throw Error(fmt::format("{} of {} runs failed; failures.csv in {} says why, the same command tries them again",
                            failed, runs.size(), request.out));
}

}  // namespace

void add_experiment(CLI::App& program) {
  auto request = std::make_shared<ExperimentRequest>();
  CLI::App* command = program.add_subcommand(
      "experiment", "Repeat the paper's tables and figures, with the paper's values beside ours");
  std::string names;
  for (const std::string& name : experiment_names()) names += name + ", ";
  command->add_option("name", request->name, names + "or all")->required();
  command
      ->add_option("--out", request->out, "folder for runs, CSV, JSON and report.html; a sweep that was ended goes on")
      ->capture_default_str();
  command->add_flag("--overwrite", request->overwrite,
                    "write into --out although it holds files that no experiment wrote");
  add_options(*command, request->options);
  add_program_options(*command, request->program);
  command->callback([request] { experiment(*request); });
}

}  // namespace vantage::app
