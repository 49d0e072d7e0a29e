#pragma once

#include "vantage/map/voxel_map.hpp"
#include "vantage/model/surface_field.hpp"

namespace vantage {

/// The field closed where nobody saw anything: nodes without a measurement are outside where frames looked through them
/// or the map says empty, and outside of the map's enclosure; between these and the measured ones the distance is the
/// smooth one (harmonic), so that the caps are. Throws InputError where the enclosure has too many cells.
[[nodiscard]] SurfaceField closed_field(const SurfaceField& field, const VoxelMap& map);

}  // namespace vantage
