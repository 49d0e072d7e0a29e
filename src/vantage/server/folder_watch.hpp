#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "vantage/server/live_run.hpp"

namespace vantage {

/// Shows the output folder of a reconstruction: its report, or while it goes on its log (io/run_log.hpp). Or that of an
/// experiment: its report, or until there is one how many runs are finished.
class FolderWatch {
 public:
  /// Throws InputError where `folder` is no output folder of a run or experiment. `run` must outlive this.
  FolderWatch(std::filesystem::path folder, LiveRun& run);

  /// Tells `run` what is new in the folder since the last call. Throws InputError where a file is not as it must be.
  void look();

 private:
  /// What tells a file from the one that was there before.
  struct Stamp {
    std::uint64_t file = 0;
    std::int64_t seconds = 0, nanoseconds = 0;
    bool operator==(const Stamp&) const = default;
  };

  [[nodiscard]] static Stamp stamp_of(const std::filesystem::path& path);
  void follow_log();
  void take_line(const std::string& line);
  void show_report();
  void show_progress();

  std::filesystem::path folder_;
  LiveRun& run_;
  std::uint64_t log_file_ = 0;  // the log that is followed; 0: none
  std::uint64_t log_read_ = 0;  // bytes of it, whole lines
  bool finished_ = false;       // the run of the log has said so
  bool report_shown_ = false;
  Stamp report_;
  std::optional<std::size_t> runs_shown_;  // of an experiment without a report
};

}  // namespace vantage
