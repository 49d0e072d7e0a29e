#pragma once

#include <vector>

#include "vantage/core/point_cloud.hpp"

namespace vantage {

/// A surface reduced to one oriented point per cell of a cubic lattice (two where a thin wall shows both its sides).
struct Surfels {
  PointCloud cloud;             // mean point of the cell; normal of the plane fitted to the cell and those around it
  std::vector<char> on_border;  // 1 where the surface has been seen to one side only
  double cell = 0;              // lattice constant, metres

  [[nodiscard]] std::size_t size() const { return cloud.size(); }
};

/// Reduces a cloud. Points without a normal are left out: their side is unknown. Surfels come in the order in which the
/// cloud's points first enter their cells. Throws InputError unless `cell` is positive.
[[nodiscard]] Surfels make_surfels(const PointCloud& cloud, double cell);

}  // namespace vantage
