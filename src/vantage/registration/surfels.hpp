#pragma once

#include <vector>

#include "vantage/core/point_cloud.hpp"

namespace vantage {

/// A surface reduced to one oriented point per cell of a cubic lattice (two where a thin wall shows both its sides).
struct Surfels {
  PointCloud cloud;           // mean point of the cell; normal of a plane fitted there
  std::vector<char> is_flat;  // 1 where the points lie close to the plane: neither an edge nor lost in noise
  double cell = 0;            // lattice constant, metres

  [[nodiscard]] std::size_t size() const { return cloud.size(); }
  /// Share of the surfels that are flat, 0..1.
  [[nodiscard]] double flat_share() const;
};

/// Reduces a cloud. The plane is fitted to the points of the cell where they show one, otherwise to those of the 27
/// cells around it that face the same way. Points without a normal are left out: their side is unknown. Surfels come in
/// the order in which the cloud's points first enter their cells. Throws InputError unless `cell` is positive.
[[nodiscard]] Surfels make_surfels(const PointCloud& cloud, double cell);

}  // namespace vantage
