#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/io/report_data.hpp"
#include "vantage/io/software_renderer.hpp"

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

  /// The run as a report shows it; this must outlive the result.
  [[nodiscard]] ReportData report_data() const;
};

/// Reads the folder. Any of the files may be missing, but not all of map, cloud and mesh. Throws InputError naming the
/// file and what is wrong with it.
[[nodiscard]] StoredRun read_stored_run(const std::filesystem::path& folder);

/// A picture of a run.
struct RunPicture {
  std::string show = "views";  // see run_picture_subjects()
  int width = 1200, height = 800;
  double turn = 28;  // degrees around the object from -y towards +x
  double rise = 24;  // degrees above the horizon
  Vec3 up = Vec3::UnitZ();

  /// Throws InputError naming the field.
  void validate() const;
};

/// `views`: the model among its cameras; `model`: the surface, or else the cloud, or else the voxels; `quality`,
/// `normals`, `labels`: the occupied voxels coloured.
[[nodiscard]] std::vector<std::string> run_picture_subjects();

/// Throws InputError where the run has nothing of the kind to show.
[[nodiscard]] Picture draw(const StoredRun& run, const RunPicture& picture);

}  // namespace vantage
