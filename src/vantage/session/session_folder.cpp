#include "vantage/session/session_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "vantage/core/error.hpp"
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
constexpr const char* in_use = "another process has this session open; end it, or wait for it";

/// The number that a file's name stands for, where it has this ending.
std::optional<int> number_of(const fs::path& file, const char* ending) {
  if (file.extension() != ending) return std::nullopt;
  const std::string stem = file.stem().string();
  int number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (error != std::errc() || end != stem.data() + stem.size() || number < 0) return std::nullopt;
  return number;
}

void create_folders(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw Error(fmt::format("cannot create the session {}: {}", path.string(), error.message()));
}

}  // namespace

bool SessionFolder::is_session(const fs::path& path) { return fs::exists(path / data_folder / options_file); }

void SessionFolder::create(const fs::path& path, const ScanPlanningOptions& options) {
  options.validate();
  (void)scene_in(session_box(options), options.scene);
  const fs::path data = path / data_folder;
  require(!fs::exists(data / options_file), path.string(),
          ": already is a session; add scans to it or give another folder");
  create_folders(data);
  const FolderLock lock(data, in_use);
  ScanPlanningOptions copy = options;
  // The session may be opened from anywhere; numbers stand as they are.
  const auto make_absolute = [](std::string& file) { file = fs::absolute(file).lexically_normal().string(); };
  if (copy.planning.robot) make_absolute(*copy.planning.robot);
  if (copy.planning.package) copy.planning.package = absolute_packages(*copy.planning.package, {});
  if (copy.reading.hand_eye_is_file()) make_absolute(copy.reading.hand_eye);
  write_file_atomically(data / options_file, "# vantage session, format 1\n" + options_as_yaml(option_fields(copy)));
}

ScanPlanningOptions SessionFolder::options_of(const fs::path& path) {
  const fs::path file = path / data_folder / options_file;
  require(fs::exists(file), path.string(), ": is no session; make one with `vantage session new`");
  ScanPlanningOptions options;
  set_options_from_yaml(option_fields(options), read_file(file), file.string());
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
  for (const auto& entry : fs::directory_iterator(data_)) {
    const fs::path& file = entry.path();
    if (file.extension() == ".tmp") unfinished.push_back(file);
    if (const auto number = number_of(file, ".scan")) scans_.push_back(*number);
    for (const char* ending : {".scan", ".damaged"}) next_ = std::max(next_, number_of(file, ending).value_or(-1) + 1);
  }
  std::sort(scans_.begin(), scans_.end());
  std::sort(unfinished.begin(), unfinished.end());
  for (const fs::path& file : unfinished) {
    dropped_.push_back(fmt::format("dropped {}: its write was never finished or acknowledged", file.string()));
    std::error_code ignored;
    fs::remove(file, ignored);
  }
}

void SessionFolder::read_skipped() {
  const fs::path file = data_ / skipped_file;
  if (!fs::exists(file)) return;
  try {
    skipped_ = parse_skipped_views(read_sealed(file), file.string());
  } catch (const InputError& error) {
    dropped_.push_back(fmt::format("forgot which views were skipped: {}", error.what()));
  }
}

fs::path SessionFolder::file(int number, const char* ending) const {
  return data_ / fmt::format("{:06}{}", number, ending);
}

int SessionFolder::store(const SessionScan& scan) {
  const int number = next_;
  write_sealed(file(number, ".scan"), scan_bytes(scan));
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
  scans_.erase(std::remove(scans_.begin(), scans_.end(), number), scans_.end());
  dropped_.push_back(fmt::format("left out scan {}, kept as {}: {}", number, kept.string(), why));
}

void SessionFolder::store_located(int number, const Located& found) const {
  write_sealed(file(number, ".located"), located_text(found));
}

std::optional<Located> SessionFolder::located(int number) const {
  const fs::path path = file(number, ".located");
  try {
    if (fs::exists(path)) return parse_located(read_sealed(path), path.string());
  } catch (const InputError&) {
    // Registration finds the same again.
  }
  return std::nullopt;
}

void SessionFolder::store_skipped(const std::map<int, std::string>& skipped) {
  write_sealed(data_ / skipped_file, skipped_views_text(skipped));
  skipped_ = skipped;
}

}  // namespace vantage
