#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/core/triangle_mesh.hpp"
#include "vantage/runs/run_data.hpp"

namespace vantage {

/// What an output folder (spec, section 10) holds of a run's result: map.nrrd with map.ply, model.ply, mesh.ply, the
/// views of summary.json, camera and candidates of config.yaml.
struct StoredRun {
  std::string object;
  std::optional<VoxelMap> map;
  PointCloud cloud;               // empty: none
  TriangleMesh mesh;              // empty: none
  std::vector<ScanRecord> scans;  // number, candidate, poses and verdict
  RangeCamera camera;
  Candidates candidates;
};

/// Reads the folder. Any of the files may be missing, but not all of map, cloud and mesh. Throws InputError naming the
/// file and what is wrong with it.
[[nodiscard]] StoredRun read_stored_run(const std::filesystem::path& folder);

}  // namespace vantage
