#pragma once

#include <nanoflann.hpp>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A list of points as nanoflann reads it.
struct TreePoints {
  const std::vector<Vec3>* points;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points->size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return (*points)[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;  // nanoflann computes it
  }
};
using PointTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, TreePoints>, TreePoints, 3>;

}  // namespace vantage
