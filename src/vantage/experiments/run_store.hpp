#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vantage/experiments/sweep_run.hpp"
#include "vantage/runs/output_folder.hpp"

namespace vantage {

/// The finished runs of sweeps, one file each: `runs/NAME-DIGEST.json` with program, configuration and outcome, the
/// same bytes whenever the same run is repeated, and `times/NAME-DIGEST.json` with what the clock said. Files are
/// written aside, synced and renamed, so a sweep that is killed keeps every run that was finished.
class RunStore {
 public:
  /// Creates the folders, or goes on with those of an earlier sweep. `program`: which program makes the runs; outcomes
  /// of another one are not reused. Throws as OutputFolder does.
  RunStore(const std::filesystem::path& folder, std::string program, ForeignFiles foreign = ForeignFiles::refuse);

  /// The stored outcome of this run, if program and configuration agree in full; nothing for a run that failed, was
  /// made by another program or whose file is damaged.
  [[nodiscard]] std::optional<RunOutcome> load(const SweepRun& run) const;
  void save(const SweepRun& run, const RunOutcome& outcome) const;
  /// Why a run failed, for people; the next start tries it again.
  void save_failure(const SweepRun& run, const std::string& error) const;

  [[nodiscard]] std::filesystem::path file_of(const SweepRun& run) const;

 private:
  [[nodiscard]] std::filesystem::path times_of(const SweepRun& run) const;

  OutputFolder folder_;
  std::filesystem::path runs_, times_;
  std::string program_;
};

}  // namespace vantage
