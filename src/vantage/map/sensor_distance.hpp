#pragma once

#include "vantage/map/grid.hpp"

namespace vantage {

/// Throws InputError where a sensor stands so far from the map that its voxels cannot be counted any more.
void require_near(const Grid& grid, const Vec3& sensor);

}  // namespace vantage
