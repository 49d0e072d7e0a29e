#include "vantage/session/session_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/session/sealed_file.hpp"
#include "vantage/session/session_model.hpp"
#include "vantage/session/skipped_views.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr const char* data_folder = "session";
constexpr const char* options_file = "options.yaml";
constexpr const char* skipped_file = "skipped.json";
constexpr std::string_view format_line = "# vantage session, format ";
constexpr int format = 2;  // 1 had no checksum at the end of options.yaml
constexpr std::string_view checksum_line = "# crc32 ";
constexpr int largest_number = 999'999'999;
constexpr const char* in_use = "another process has this session open; end it, or wait for it";

/// The number that a file's name stands for, where it has this ending.
std::optional<int> number_of(const fs::path& file, const char* ending) {
  if (file.extension() != ending) return std::nullopt;
  const std::string stem = file.stem().string();
  if (stem.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  const std::optional<int> number = number_from<int>(stem);
  return number && *number <= largest_number ? number : std::nullopt;
}

/// Endings of files that hold a scan: one of the session, one that is damaged, one that was taken out.
constexpr std::array<const char*, 3> scan_endings{".scan", ".damaged", ".removed"};

/// The options as YAML, with the format before and their checksum behind them as comments.
std::string options_text(ScanPlanningOptions options) {
  const std::string text = fmt::format("{}{}\n{}", format_line, format, options_as_yaml(option_fields(options)));
  return fmt::format("{}{}{}\n", text, checksum_line, checksum_of(text));
}

/// Throws InputError where the bytes are not what options_text() made, or another program did that came before it.
void require_whole_options(std::string_view bytes, const std::string& name) {
  const int found = bytes.starts_with(format_line) ? leading_number(bytes.substr(format_line.size())) : 0;
  require(found >= 1, name, ": is damaged; its first line must be '", format_line, format, "'");
  require(found <= format, name, ": has format ", found, "; this program knows ", format,
          ", take the one that made the session, or a newer one");
  if (found == 1) return;
  const std::size_t last = bytes.rfind(checksum_line);
  require(last != std::string_view::npos, name, ": is damaged: cut off, it has no checksum");
  require(bytes.substr(last) == fmt::format("{}{}\n", checksum_line, checksum_of(bytes.substr(0, last))), name,
          ": is damaged; its checksum does not fit");
}

bool holds_scans(const fs::path& data) {
  for (const auto& entry : fs::directory_iterator(data)) {
    for (const char* ending : scan_endings)
      if (number_of(entry.path(), ending)) return true;
  }
  return false;
}

/// The session may be opened from anywhere: options that name files hold from there too.
void make_absolute(ScanPlanningOptions& options) {
  const auto absolute = [](std::string& file) {
    if (!file.empty()) file = fs::absolute(file).lexically_normal().string();
  };
  if (options.planning.robot) absolute(*options.planning.robot);
  if (options.planning.package) options.planning.package = absolute_packages(*options.planning.package, {});
  if (options.reading.hand_eye_is_file()) absolute(options.reading.hand_eye);
  // These are looked for in the scans' folder too: only what is there from here is meant from here.
  std::error_code ignored;
  for (std::string* file : {&options.reading.poses, &options.reading.intrinsics, &options.reading.masks})
    if (fs::exists(*file, ignored)) absolute(*file);
}

}  // namespace

bool SessionFolder::is_session(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path / data_folder / options_file, ignored);
}

void SessionFolder::create(const fs::path& path, const ScanPlanningOptions& options) {
  options.validate();
  const ScanScene scene = scene_in(session_box(options), options.scene);
  const VoxelMap fits_in_memory(scene.scene);
  options.require_can_plan(scene.scene);
  const fs::path data = path / data_folder;
  const auto require_none = [&path] {
    require(!is_session(path), path.string(), ": already is a session; add scans to it or give another folder");
  };
  require_none();  // one that is open says so too
  create_folders(data);
  const FolderLock lock(data, in_use);
  require_none();
  require(!holds_scans(data), data.string(), ": holds the scans of a session whose ", options_file,
          " is gone; put that back, or give another folder");
  ScanPlanningOptions copy = options;
  make_absolute(copy);
  write_file_atomically(data / options_file, options_text(std::move(copy)));
}

ScanPlanningOptions SessionFolder::options_of(const fs::path& path) {
  const fs::path file = path / data_folder / options_file;
  require(is_session(path), path.string(), ": is no session; make one with `vantage session new`");
  ScanPlanningOptions options;
  const std::string text = read_file(file);
  require_whole_options(text, file.string());
  set_options_from_yaml(option_fields(options), text, file.string());
  options.validate();
  try {
    options.load_robot_model();
  } catch (const Error&) {
    // Scans can be added without it, and plans say what is wrong.
  }
  require(options.scene.box.has_value(), file.string(), ": has no box");
  return options;
}

SessionFolder::SessionFolder(const fs::path& path)
    : path_(path), data_(path / data_folder), options_(options_of(path)) {
  lock_.emplace(data_, in_use);
  list_files();
  read_skipped();
}

void SessionFolder::list_files() {
  std::vector<fs::path> unfinished;
  std::set<int> known;  // numbers that some file has
  for (const auto& entry : fs::directory_iterator(data_)) {
    const fs::path& file = entry.path();
    if (file.extension() == ".tmp") unfinished.push_back(file);
    if (const auto number = number_of(file, ".scan")) scans_.push_back(*number);
    if (const auto number = number_of(file, ".removed")) removed_.insert(*number);
    for (const char* ending : scan_endings)
      if (const auto number = number_of(file, ending)) known.insert(*number);
    // One whose scan is gone: its number must not be another scan's.
    next_ = std::max(next_, number_of(file, ".located").value_or(-1) + 1);
  }
  if (!known.empty()) next_ = std::max(next_, *known.rbegin() + 1);
  report_missing(known);
  std::sort(scans_.begin(), scans_.end());
  std::sort(unfinished.begin(), unfinished.end());
  for (const fs::path& file : unfinished) {
    dropped_.push_back(fmt::format("dropped {}: its write was never finished or acknowledged", file.string()));
    std::error_code ignored;
    fs::remove(file, ignored);
  }
}

void SessionFolder::report_missing(const std::set<int>& known) {
  constexpr std::size_t most_named = 10;
  std::size_t missing = static_cast<std::size_t>(next_) - known.size();
  std::size_t named = 0;
  for (int number = 0; missing > 0 && named < most_named; ++number) {
    if (known.contains(number)) continue;
    dropped_.push_back(fmt::format("scan {} is missing: its file {} is gone", number, file(number, ".scan").string()));
    ++named;
    --missing;
  }
  if (missing > 0) dropped_.push_back(fmt::format("{} more scans are missing: their files are gone", missing));
}

void SessionFolder::read_skipped() {
  const fs::path file = data_ / skipped_file;
  std::error_code error_code;
  if (fs::symlink_status(file, error_code).type() == fs::file_type::not_found) return;
  try {
    skipped_ = parse_skipped_views(read_sealed(file), file.string());
  } catch (const std::exception& error) {
    dropped_.push_back(fmt::format("forgot which views were skipped: {}", error.what()));
  }
}

fs::path SessionFolder::file(int number, const char* ending) const {
  return data_ / fmt::format("{:06}{}", number, ending);
}

int SessionFolder::store(const SessionScan& scan) {
  const int number = next_;
  if (number > largest_number) throw Error(fmt::format("{}: has no number left for a scan", data_.string()));
  const fs::path path = file(number, ".scan");
  std::error_code ignored;
  fs::remove(file(number, ".located"), ignored);  // of a scan that had this number before; bound to that one anyhow
  try {
    write_sealed(path, scan_bytes(scan));
  } catch (const SyncError& error) {
    if (::unlink(path.c_str()) == 0) throw;
    // It cannot be taken back either. Its number is used up, so that opening finds this scan or none under it.
    ++next_;
    throw Error(fmt::format("{}; it may be there when the session is opened again", error.what()));
  }
  scans_.push_back(number);
  ++next_;
  return number;
}

SessionScan SessionFolder::read(int number) const {
  const fs::path path = file(number, ".scan");
  std::string bytes;
  try {
    bytes = read_file(path);
  } catch (const InputError& error) {
    throw Error(error.what());  // perhaps it may be read another time
  }
  return parse_scan(unsealed(bytes, path.string()), path.string());
}

void SessionFolder::set_aside(int number, const std::string& why) {
  const fs::path kept = file(number, ".damaged");
  std::error_code error;
  fs::rename(file(number, ".scan"), kept, error);
  std::erase(scans_, number);
  dropped_.push_back(error ? fmt::format("left out scan {}: {} (it cannot be renamed to {}: {})", number, why,
                                         kept.string(), error.message())
                           : fmt::format("left out scan {}, kept as {}: {}", number, kept.string(), why));
}

void SessionFolder::pass_over(int number, const std::string& why) {
  std::erase(scans_, number);
  dropped_.push_back(fmt::format("left out scan {}: {}", number, why));
}

void SessionFolder::forget_located_from(int number) const {
  for (int each = number; each < next_; ++each) {
    std::error_code error;
    fs::remove(file(each, ".located"), error);
    if (error) throw Error(fmt::format("{}: cannot be removed: {}", file(each, ".located").string(), error.message()));
  }
}

void SessionFolder::remove(int number) {
  // First: whoever opens the folder after a kill in between registers again and finds the same.
  forget_located_from(number);
  rename_and_sync(file(number, ".scan"), file(number, ".removed"));
  std::erase(scans_, number);
  removed_.insert(number);
}

void SessionFolder::restore(int number) {
  forget_located_from(number);
  rename_and_sync(file(number, ".removed"), file(number, ".scan"));
  removed_.erase(number);
  scans_.insert(std::upper_bound(scans_.begin(), scans_.end(), number), number);
}

std::string SessionFolder::seal_of_scan(int number) const { return seal_of_file(file(number, ".scan")); }

void SessionFolder::store_located(int number, const Located& found) const {
  write_sealed(file(number, ".located"), located_text(found, seal_of_scan(number)));
}

std::optional<Located> SessionFolder::located(int number) const {
  const fs::path path = file(number, ".located");
  try {
    const StoredLocated stored = parse_located(read_sealed(path), path.string());
    if (stored.scan_checksum == seal_of_scan(number)) return stored.located;
  } catch (const std::exception&) {
    // Missing, damaged, not readable or of another scan: registration finds the same again.
  }
  return std::nullopt;
}

void SessionFolder::store_skipped(const std::map<int, std::string>& skipped) {
  write_sealed(data_ / skipped_file, skipped_views_text(skipped));
  skipped_ = skipped;
}

}  // namespace vantage
