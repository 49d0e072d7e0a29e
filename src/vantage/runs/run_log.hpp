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

  /// Begins a new log in `folder`. Throws Error where it cannot be written or another program writes it.
  explicit RunLog(const std::filesystem::path& folder);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  /// Throws Error where the disk is full.
  void add(std::string_view event, const nlohmann::ordered_json& data);
  /// Takes the file away: the report has all that was in it.
  void remove();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace vantage
