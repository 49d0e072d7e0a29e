#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/core/triangle_mesh.hpp"
#include "vantage/model/scan_record.hpp"
#include "vantage/report/svg_map.hpp"
#include "vantage/runs/run_data.hpp"

namespace vantage {

/// All that a report shows of one run. Pointers may be null; what they point to must outlive the call.
struct ReportData {
  std::string object;                                        // what people call it
  std::string command = "reconstruct";                       // what made it
  std::string program;                                       // name and version
  std::vector<std::pair<std::string, std::string>> options;  // name and value, in the order to be shown
  RangeCamera camera;
  Candidates candidates;
  std::vector<ScanRecord> scans;
  std::string stop_reason;  // empty while it goes on
  const VoxelMap* map = nullptr;
  const PointCloud* cloud = nullptr;
  const TriangleMesh* mesh = nullptr;
  std::vector<std::pair<int, LabelLayer>> layers;  // kept on the way (see label_layer), each with its scan
  Vec3 up = Vec3::UnitZ();                         // of the object, for the pictures
  std::optional<double> seconds;                   // wall-clock time of the whole run
};

/// What a recorded run shows; `run` and `map`, the map after the last scan, must outlive it. Throws InputError where
/// the recorded changes do not fit the map.
[[nodiscard]] ReportData report_data(const RunData& run, const VoxelMap& map);

}  // namespace vantage
