#pragma once

#include <filesystem>

#include "vantage/model/surface_volume.hpp"

namespace vantage {

/// The mesh of a run's output folder: its mesh.ply, or, where the options ask for cells of their own or for a closed
/// mesh, built again from the range images in `scans/`, the poses and the map. Throws InputError naming what the folder
/// lacks.
[[nodiscard]] MeasuredMesh mesh_of_run(const std::filesystem::path& folder, const SurfaceOptions& options = {});

}  // namespace vantage
