#include "vantage/runs/output_folder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/format_version.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr const char* marker = ".vantage-run";
constexpr const char* lock_file = ".lock";
constexpr const char* folder_in_use =
    "another run or another experiment is writing there; wait for it or choose another --out";
constexpr std::string_view marker_line = "# vantage run, format ";
constexpr int run_format = 1;
constexpr std::string_view command_line = "\ncommand: ";

/// Whether a name fits a pattern with one `*`, which stands for digits.
bool fits(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  const std::string_view before = pattern.substr(0, star), after = pattern.substr(star + 1);
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) return false;
  return name.substr(before.size(), name.size() - before.size() - after.size()).find_first_not_of("0123456789") ==
         std::string_view::npos;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    entries.push_back(entry->path());
  if (error && error != std::errc::no_such_file_or_directory)
    throw Error(fmt::format("{}: cannot be used as output folder: {}", folder.string(), error.message()));
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::string text_of(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) ? read_file(file) : std::string();
}

/// The command that made the folder, or empty. Folders of earlier versions have no marker, but a configuration.
std::string maker_of(const fs::path& folder) {
  const std::string text = text_of(folder / marker);
  if (text.starts_with(marker_line)) {
    const int found = leading_number(std::string_view(text).substr(marker_line.size()));
    require_known_format(found, run_format, (folder / marker).string());
    if (const std::size_t at = text.find(command_line); at != std::string::npos) {
      const std::size_t begin = at + command_line.size();
      return text.substr(begin, text.find('\n', begin) - begin);
    }
  }
  const std::string config = text_of(folder / "config.yaml");
  constexpr std::string_view start = "# vantage ";
  std::error_code ignored;
  const bool is_run = fs::exists(folder / "summary.json", ignored) && fs::exists(folder / "views.csv", ignored);
  if (is_run && config.starts_with(start))
    return config.substr(start.size(), config.find_first_of(" \n", start.size()) - start.size());
  const bool is_sweep = fs::is_directory(folder / "runs", ignored) && fs::is_directory(folder / "times", ignored);
  return is_sweep ? "experiment" : "";
}

/// Files with these names that are in the folder.
std::vector<fs::path> present(const fs::path& folder, const OutputNames& names) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const std::string& name : names.files)
    if (fs::symlink_status(folder / name, ignored).type() != fs::file_type::not_found) files.push_back(folder / name);
  for (const std::string& pattern : names.patterns) {
    const fs::path below = folder / fs::path(pattern).parent_path();
    for (const fs::path& entry : entries_of(below))
      if (fits(entry.filename().string(), fs::path(pattern).filename().string())) files.push_back(entry);
  }
  return files;
}

/// Some file of others in the folder, if there is one; nothing where it is missing, empty or was only begun.
std::optional<fs::path> foreign_file(const fs::path& folder) {
  for (const fs::path& entry : entries_of(folder)) {
    const std::string name = entry.filename().string();
    if (name != lock_file && name != marker && !name.starts_with(fmt::format(".{}.", marker))) return entry;
  }
  return std::nullopt;
}

void require_ours(const fs::path& folder, const OutputNames& names) {
  const std::string maker = maker_of(folder);
  std::error_code ignored;
  const bool holds_session = fs::exists(folder / "session" / "options.yaml", ignored);
  if (names.command == "session") {
    if (maker == "session") return;
    const std::vector<fs::path> in_the_way = present(folder, names);
    require(in_the_way.empty(), in_the_way.empty() ? "" : in_the_way.front().string(),
            ": would be overwritten, and the session did not write it; move it away, or say --overwrite");
    return;
  }
  require(!holds_session, folder.string(), ": is the folder of a session; choose another one with --out");
  const bool is_sweep = names.command == "experiment";
  if (!maker.empty() && (maker == "experiment") == is_sweep) return;
  const auto file = foreign_file(folder);
  require(!file, folder.string(), ": is not empty, and no ", is_sweep ? "experiment" : "run", " made it (there is ",
          file.value_or(fs::path()).filename().string(),
          "); choose another folder with --out, or say --overwrite to replace files of the run's names in it");
}

void remove_old_output(const fs::path& folder, const OutputNames& names) {
  for (const fs::path& file : present(folder, names)) {
    std::error_code error;
    if (!fs::is_directory(file, error)) fs::remove(file, error);
    if (error) throw Error(fmt::format("{}: of an earlier run, cannot be removed: {}", file.string(), error.message()));
  }
  for (const std::string& name : names.files) remove_unfinished(folder / name);
  for (const std::string& pattern : names.patterns) {
    const fs::path below = folder / fs::path(pattern).parent_path();
    for (const fs::path& entry : entries_of(below)) {
      // `.scan-000.pose.txt.PID-N.tmp` is of scan-000.pose.txt.
      const std::string name = entry.filename().string();
      const std::size_t end = name.size() > 4 ? name.rfind('.', name.size() - 5) : std::string::npos;
      if (!name.starts_with('.') || !name.ends_with(".tmp") || end == std::string::npos || end < 1) continue;
      const std::string target = name.substr(1, end - 1);
      if (fits(target, fs::path(pattern).filename().string())) remove_unfinished(below / target);
    }
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, const OutputNames& names, ForeignFiles foreign) : path_(path) {
  if (foreign == ForeignFiles::refuse) require_ours(path, names);  // before anything is written there
  create_folders(path);
  lock_.emplace(path, folder_in_use);
  if (foreign == ForeignFiles::refuse) require_ours(path, names);
  remove_unfinished(path / marker);
  write_file_atomically(path / marker, fmt::format("{}{}{}{}\n", marker_line, run_format, command_line, names.command));
  remove_old_output(path, names);
}

std::string name_of_folder(const fs::path& path) {
  fs::path whole = fs::absolute(path).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  return whole.filename().string();
}

}  // namespace vantage
