#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// Unit normals of points measured on a grid by any scanner, facing the origins of their sight lines (one for all
/// points or one each): from the cross product of the differences to the neighbours along row and column.
/// `point_of_cell` has the point of each cell, row by row, -1 for none. A neighbour belongs to another surface where
/// the step along the sight line is more than 12 times the step across it (85 degrees). (0,0,0) where no neighbour is
/// left in one of the directions.
[[nodiscard]] std::vector<Vec3f> organised_normals(Resolution grid, std::span<const std::int32_t> point_of_cell,
                                                   std::span<const Vec3> points, std::span<const Vec3> origins);

}  // namespace vantage
