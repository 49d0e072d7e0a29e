#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace vantage {

/// live.jsonl in a run's folder: one line {"event": name, "data": …} for each event of docs/report-data.md ("Live"),
/// the first one `run` with the whole document. It is there while the run goes on, for `vantage serve`, and locked
/// (flock) by the program that writes it, so that one can tell a run that goes on from one that was killed.
class RunLog {
 public:
  static constexpr std::string_view file_name = "live.jsonl";

  /// Begins a new log in `folder`, in the place of one that a killed run left. Only the one who holds the folder's lock
  /// (OutputFolder) may do so. Throws Error where it cannot be written, or another program writes the old one.
  explicit RunLog(const std::filesystem::path& folder);
  /// Takes away a log that has no event.
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  /// Whether a program still writes this log. Asking keeps no run from starting.
  [[nodiscard]] static bool is_written(const std::filesystem::path& log);

  /// Throws Error where the disk is full.
  void add(std::string_view event, const nlohmann::ordered_json& data);
  /// Takes the file away: the report has all that was in it.
  void remove();

 private:
  [[nodiscard]] bool is_mine() const;

  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace vantage
