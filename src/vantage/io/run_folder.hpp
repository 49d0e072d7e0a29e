#pragma once

#include <filesystem>

#include "vantage/io/run_files.hpp"
#include "vantage/reconstruction/options.hpp"

namespace vantage {

/// All that a finished run leaves behind.
struct RunResult {
  const ObjectModel& model;
  RunSummary summary;
  ReconstructOptions options;
};

/// The output folder of a reconstruction (spec, section 10). Scans are written as they are taken; the rest at the end.
/// Every file appears under its name only when it is complete.
class RunFolder {
 public:
  /// Creates the folder. Throws Error where that is not possible.
  explicit RunFolder(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes `scans/scan-NNN.*` of a scan with the pose that registration gave it.
  void add_scan(const ScanRecord& record, const Scan& scan, const VoxelMap& map);
  /// Writes everything else; `mesh.ply` and `report.html` only where `with_report` asks for them.
  void finish(const RunResult& result, double total_seconds, bool with_report);

 private:
  std::filesystem::path path_;
};

}  // namespace vantage
