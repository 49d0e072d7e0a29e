#include "vantage/runs/stored_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/runs/output_folder.hpp"
#include "vantage/runs/stored_run_files.hpp"

namespace vantage {

StoredRun read_stored_run(const std::filesystem::path& folder) {
  require(std::filesystem::is_directory(folder), folder.string(), ": is no folder; it must be the output of a run");
  const auto has = [&](const char* file) { return std::filesystem::exists(folder / file); };
  require(has("map.nrrd") || has("model.ply") || has("mesh.ply"), folder.string(),
          ": has neither map.nrrd nor model.ply nor mesh.ply; it must be the output of a run");
  StoredRun run;
  run.object = name_of_folder(folder);
  if (has("map.nrrd")) run.map = read_map(folder / "map.nrrd");
  if (has("model.ply")) run.cloud = read_cloud(folder / "model.ply").cloud;
  if (has("mesh.ply")) run.mesh = read_mesh(folder / "mesh.ply");
  if (has("summary.json")) {
    const std::filesystem::path file = folder / "summary.json";
    StoredSummary summary = parse_run_summary(read_file(file), file.string());
    run.object = summary.object.value_or(run.object);
    run.scans = std::move(summary.scans);
  }
  if (has("config.yaml")) {
    const std::filesystem::path file = folder / "config.yaml";
    const StoredConfig config = parse_run_config(read_file(file), file.string());
    const Vec3 center = run.map ? run.map->enclosure_center() : Vec3(Vec3::Zero());
    try {
      if (config.camera) run.camera = camera_from_text(*config.camera);
      if (config.candidates) run.candidates = candidates_from_text(*config.candidates, center);
    } catch (const InputError& error) {
      throw InputError(concat(file.string(), ": ", error.what()));
    }
  }
  return run;
}

}  // namespace vantage
