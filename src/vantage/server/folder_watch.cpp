#include "vantage/server/folder_watch.hpp"

#include <sys/stat.h>

#include <fstream>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/format_version.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/report/report.hpp"
#include "vantage/runs/run_log.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// Whether an experiment keeps its runs here (experiments/run_store.hpp).
bool is_of_experiment(const std::filesystem::path& folder) {
  return std::filesystem::is_directory(folder / "runs") && std::filesystem::is_directory(folder / "times");
}

/// What there is to say of an experiment before its report.
Json progress_document(std::size_t runs) {
  return {
      {"format", "vantage-experiment"},
      {"version", 1},
      {"title", "Experiment under way"},
      {"text",
       {concat(runs, runs == 1 ? " run is" : " runs are", " finished."),
        "The report is shown here when the last one is. An experiment that was ended goes on by the same command."}},
      {"figures", Json::array()},
      {"tables", Json::array()}};
}

}  // namespace

FolderWatch::Stamp FolderWatch::stamp_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

FolderWatch::FolderWatch(std::filesystem::path folder, LiveRun& run) : folder_(std::move(folder)), run_(run) {
  require(std::filesystem::is_directory(folder_), folder_.string(),
          ": is no folder; it must be the output of a reconstruction or experiment");
  const auto has = [&](std::string_view file) { return std::filesystem::exists(folder_ / file); };
  require(has(RunLog::file_name) || has("report.html") || has("scans") || is_of_experiment(folder_), folder_.string(),
          ": has neither report.html nor scans; it must be the output of a reconstruction or experiment");
  require(has(RunLog::file_name) || has("report.html") || !has("summary.json"), folder_.string(),
          ": has no report.html; reconstruct again without --no-report");
}

void FolderWatch::look() {
  if (std::filesystem::exists(folder_ / RunLog::file_name)) {
    follow_log();
  } else {
    log_file_ = 0;
    if (!report_shown_ && !std::filesystem::exists(folder_ / "report.html")) show_progress();
    show_report();
  }
}

void FolderWatch::follow_log() {
  const std::filesystem::path path = folder_ / RunLog::file_name;
  const bool was_written = RunLog::is_written(path);  // asked before reading, so that nothing can follow what is read
  std::ifstream log(path, std::ios::binary);
  const std::uint64_t file = stamp_of(path).file;
  if (!log || file == 0) return;  // it has just been taken away
  // A new log may get the number of one that was removed; then it is shorter.
  if (file != log_file_ || std::filesystem::file_size(path) < log_read_) {
    log_file_ = file;
    log_read_ = 0;
    finished_ = false;
  }
  log.seekg(static_cast<std::streamoff>(log_read_));
  for (std::string line; std::getline(log, line) && !log.eof();) {  // a last line without its end is not complete
    log_read_ += line.size() + 1;
    take_line(line);
  }
  if (!was_written && !finished_ && log_read_ > 0) {
    run_.add("state", {{"state", "finished"}, {"stop_reason", "the run was broken off"}});
    finished_ = true;
  }
}

void FolderWatch::take_line(const std::string& line) {
  const std::string what = concat((folder_ / RunLog::file_name).string(), ", before byte ", log_read_);
  Json json;
  try {
    json = Json::parse(line);
  } catch (const Json::exception& error) {
    throw InputError(concat(what, ": no JSON: ", error.what()));
  }
  require(json.is_object() && json.contains("event") && json["event"].is_string() && json.contains("data"), what,
          ": must be an object with event and data");
  const auto event = json["event"].get<std::string>();
  if (event == "run") {
    run_.begin(json["data"]);
    return;
  }
  run_.add(event, json["data"]);
  if (event == "state" && json["data"].value("state", "") == "finished") finished_ = true;
}

void FolderWatch::show_report() {
  const std::filesystem::path path = folder_ / "report.html";
  const Stamp stamp = stamp_of(path);
  if (stamp == Stamp{} || (report_shown_ && stamp == report_)) return;
  const bool known = finished_;  // from the log, whose end is the same
  report_ = stamp;
  report_shown_ = true;
  finished_ = false;
  if (known) return;
  auto document = document_of_page(read_file(path), path.string());
  require(document.has_value(), path.string(),
          ": has pictures only, no data for the page; the program that wrote it was built without npm");
  const std::string format = document->is_object() ? document->value("format", "") : "";
  require(format == "vantage-run" || format == "vantage-experiment", path.string(),
          ": is the report of no run and of no experiment");
  require_known_format(json_number(document->value("version", Json(1)), path.string() + ", version"), 1, path.string());
  run_.begin(std::move(*document));
}

void FolderWatch::show_progress() {
  if (!is_of_experiment(folder_)) return;
  std::size_t runs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "runs"))
    if (entry.path().extension() == ".json") ++runs;
  if (runs_shown_ == runs) return;
  runs_shown_ = runs;
  run_.begin(progress_document(runs));
}

}  // namespace vantage
