#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vantage/core/error.hpp"

namespace vantage {

/// The whole content of a regular file. Throws InputError naming the path where it is missing, a folder, a device or
/// not readable.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Thrown where a file has its name and content, but the disk did not confirm its folder: whoever opens it finds it,
/// and a power cut may lose it.
class SyncError : public Error {
 public:
  using Error::Error;
};

/// A file that appears under its name only when it is complete: bytes go to a hidden `.NAME.*.tmp` beside it, and
/// commit() syncs them to the disk, renames and syncs the folder. A run that is killed leaves the old file untouched.
/// The destructor removes what was not committed. Every failure (no such folder, no permission, full disk) is an Error
/// that names the path and the reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Small pieces are collected; call it as often as is handy.
  void write(std::string_view bytes);
  /// Makes the file appear. Nothing can be written afterwards. Throws SyncError where the file has appeared but may not
  /// outlast a power cut, another Error where the old file is still there.
  void commit();

 private:
  void flush();
  void close();
  [[noreturn]] void fail(std::string_view action, int error_number) const;

  std::filesystem::path path_;
  std::filesystem::path aside_;  // empty once there is nothing to remove
  std::string pending_;
  int descriptor_ = -1;
};

/// Writes the whole file as AtomicFile does.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Gives a file another name in its folder, which is then synced. Throws SyncError as AtomicFile::commit does, another
/// Error where it kept its name.
void rename_and_sync(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes what AtomicFile left of files with this name in the folder where the process was killed. Only where nobody
/// else may be writing them.
void remove_unfinished(const std::filesystem::path& path);

/// Makes a folder and those above it that are missing, each synced into the one above it. Throws Error naming the path
/// and the reason.
void create_folders(const std::filesystem::path& path);

}  // namespace vantage
