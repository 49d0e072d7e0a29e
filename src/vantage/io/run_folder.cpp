#include "vantage/io/run_folder.hpp"

#include "vantage/core/error.hpp"
#include "vantage/io/atomic_file.hpp"
#include "vantage/io/map_file.hpp"
#include "vantage/io/point_cloud_file.hpp"

namespace vantage {

RunFolder::RunFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  std::filesystem::create_directories(path_ / "scans", error);
  if (error) throw Error(concat("cannot create the output folder ", path_.string(), ": ", error.message()));
}

void RunFolder::add_scan(const ScanRecord&, const Scan&, const VoxelMap&) {}

void RunFolder::finish(const RunResult& result, double total_seconds, bool) {
  write_file_atomically(path_ / "summary.json", summary_json(result.model, result.summary).dump(2) + "\n");
  write_file_atomically(path_ / "views.csv", views_csv(result.model.scans));
  write_file_atomically(path_ / "timings.json", timings_json(result.model.scans, total_seconds).dump(2) + "\n");
  write_map(result.model.map, path_ / "map.nrrd");
  write_cloud_ply(path_ / "model.ply", result.model.surface.cloud());
}

}  // namespace vantage
