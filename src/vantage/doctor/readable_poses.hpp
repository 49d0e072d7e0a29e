#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "vantage/doctor/pose_files.hpp"
#include "vantage/files/temporary_folder.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// The poses of a folder in a form that the reader of scans takes: as they are where they are rigid, else fixed copies
/// in a temporary folder, which is removed in the end. Mirrored ones can be fixed by several readings.
class ReadablePoses {
 public:
  ReadablePoses(const std::filesystem::path& scans, const ScanFolderOptions& options);

  /// What is wrong with the matrices.
  [[nodiscard]] const std::vector<Finding>& findings() const { return findings_; }
  /// False where no copy could be fixed.
  [[nodiscard]] bool readable() const { return ways_ > 0; }
  /// How many readings they have.
  [[nodiscard]] int readings() const { return ways_; }
  /// The options to read them in one way.
  [[nodiscard]] ScanFolderOptions options(ScanFolderOptions options, int way) const;
  /// What to do if that way turns out to be right.
  [[nodiscard]] static std::string fix(int way);

 private:
  std::vector<Finding> findings_;
  std::optional<TemporaryFolder> copies_;  // none where the poses are good
  int ways_ = 1;
};

}  // namespace vantage
