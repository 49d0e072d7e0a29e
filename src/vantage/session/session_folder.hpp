#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "vantage/files/folder_lock.hpp"
#include "vantage/options/scan_planning_options.hpp"
#include "vantage/session/session_scan.hpp"

namespace vantage {

/// The folder `session` in the folder of a session: options.yaml, one NUMBER.scan per scan and one NUMBER.located with
/// what registration found, and skipped.json. Every file ends in a checksum and appears only when it is complete, so
/// that a process that ends at any moment leaves a folder that opens again with every scan whose store() returned. One
/// file that is damaged, cannot be read or was made by a newer program never keeps the others from being opened. One
/// process at a time.
class SessionFolder {
 public:
  /// True where create() made a session of the folder.
  [[nodiscard]] static bool is_session(const std::filesystem::path& path);
  /// The options of the session in the folder, whoever has it open. Throws InputError where it is none.
  [[nodiscard]] static ScanPlanningOptions options_of(const std::filesystem::path& path);
  /// Makes a session of the folder, which may exist. Throws InputError where it already is one or holds the scans of
  /// one, Error where another process works in it or it cannot be written.
  static void create(const std::filesystem::path& path, const ScanPlanningOptions& options);

  /// Opens it and removes what unfinished writes left. Throws InputError where the folder is no session, Error where
  /// another process has it open.
  explicit SessionFolder(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const ScanPlanningOptions& options() const { return options_; }
  /// What had to be left out, one sentence each; for the one who opens it.
  [[nodiscard]] const std::vector<std::string>& dropped() const { return dropped_; }

  /// Numbers of the scans, ascending.
  [[nodiscard]] const std::vector<int>& scans() const { return scans_; }
  /// Writes a scan; it is safe on disk when this returns its number. Throws Error, for example where the disk is full;
  /// the scan is then not part of the session.
  int store(const SessionScan& scan);
  /// Throws InputError where the file is damaged, another Error where it cannot be read or was made by a newer program.
  [[nodiscard]] SessionScan read(int number) const;
  /// Renames a damaged scan, so that it is kept and no longer read.
  void set_aside(int number, const std::string& why);
  /// Leaves a scan where it is, but out of this session.
  void pass_over(int number, const std::string& why);
  /// Takes a scan out: its file gets another name and is not read any more. What registration found for it and those
  /// after it is forgotten. Throws Error where the disk does not let it.
  void remove(int number);
  /// Takes remove() back.
  void restore(int number);
  /// Numbers of the scans that were taken out, ascending.
  [[nodiscard]] const std::set<int>& removed() const { return removed_; }

  void store_located(int number, const Located& located) const;
  /// What registration found for the scan that has this number now; nothing where that is not known or damaged.
  [[nodiscard]] std::optional<Located> located(int number) const;

  /// Candidates that were skipped, with the reason.
  [[nodiscard]] const std::map<int, std::string>& skipped() const { return skipped_; }
  void store_skipped(const std::map<int, std::string>& skipped);

 private:
  [[nodiscard]] std::filesystem::path file(int number, const char* ending) const;
  [[nodiscard]] std::string seal_of_scan(int number) const;
  void list_files();
  void report_missing(const std::set<int>& known);
  void read_skipped();
  void forget_located_from(int number) const;

  std::filesystem::path path_, data_;
  ScanPlanningOptions options_;
  std::optional<FolderLock> lock_;
  std::vector<int> scans_;
  std::set<int> removed_;
  int next_ = 0;
  std::map<int, std::string> skipped_;
  std::vector<std::string> dropped_;
};

}  // namespace vantage
