#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/files/folder_lock.hpp"

namespace vantage {

/// What becomes of an output folder that holds files which no command of ours wrote.
enum class ForeignFiles { refuse, overwrite };

/// What a command writes into its output folder.
struct OutputNames {
  std::string command;                // what writes: reconstruct, plan, session, experiment
  std::vector<std::string> files;     // names in the folder
  std::vector<std::string> patterns;  // the same with one `*` for digits, for example scans/scan-*.pose.txt
};

/// The output folder of one command: while this lives nobody else writes into it, and nothing is left in it of what a
/// command wrote there before. A file `.vantage-run` says whose the folder is; files of others in it are never touched.
class OutputFolder {
 public:
  /// Makes the folder where it is missing, or takes over one that this command or another run wrote and removes the
  /// files of these names. Throws InputError where the folder holds files and none of our commands made it, or a
  /// session's that is not this one; with `overwrite` only files of these names are replaced then. Throws Error where
  /// another process writes into it, or it cannot be written to.
  OutputFolder(const std::filesystem::path& path, const OutputNames& names,
               ForeignFiles foreign = ForeignFiles::refuse);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<FolderLock> lock_;
};

/// What people call a folder: the last name of its path, also of `DIR/` and `.`.
[[nodiscard]] std::string name_of_folder(const std::filesystem::path& path);

}  // namespace vantage
