#include "vantage/runs/run_mesh.hpp"

#include <map>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/options/options.hpp"
#include "vantage/recordings/scan_folder.hpp"
#include "vantage/runs/run_folder.hpp"
#include "vantage/runs/stored_run.hpp"

namespace vantage {
namespace {

/// The range images of a run by the name that the run gave them.
std::map<std::string, ScanFile> images_of_run(const std::filesystem::path& folder) {
  const std::filesystem::path scans = folder / "scans";
  require(std::filesystem::exists(scans / "scans.yaml"), folder.string(),
          ": has no range images in scans/, from which the mesh could be built");
  ScanFolderOptions options;
  const std::string file = (scans / "scans.yaml").string();
  set_options_from_yaml(option_fields(options), read_file(file), file);
  std::map<std::string, ScanFile> images;
  for (ScanFile& scan : open_scans(scans, options).scans) images.emplace(scan.name, std::move(scan));
  return images;
}

}  // namespace

MeasuredMesh mesh_of_run(const std::filesystem::path& folder, const SurfaceOptions& options) {
  options.validate();
  if (!options.watertight && !options.cell && std::filesystem::exists(folder / "mesh.ply"))
    return read_measured_mesh(folder / "mesh.ply");
  const StoredRun run = read_stored_run(folder);
  require(run.map.has_value(), folder.string(), ": has no map.nrrd, which says where space is empty");
  const std::map<std::string, ScanFile> images = images_of_run(folder);
  SurfaceVolume volume(run.map->grid().box(run.map->enclosure()), options);
  for (const ScanRecord& record : run.scans) {
    if (!record.merged) continue;
    const auto image = images.find(scan_file_name(record.scan));
    require(image != images.end(), folder.string(), ": scan ", record.scan,
            " is not in scans/; only runs of range images keep their scans");
    volume.fuse(image->second.read(), record.registered, std::nullopt, record.residual);
  }
  MeasuredMesh mesh = volume.mesh(*run.map);
  require(!mesh.empty(), folder.string(), ": its scans show no surface in the enclosure of the map");
  return mesh;
}

}  // namespace vantage
