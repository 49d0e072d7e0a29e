#pragma once

#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// Surface points with unit normals that face the sensor that saw them (0,0,0 where unknown). Metres, one frame.
struct PointCloud {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  // as many as points

  [[nodiscard]] std::size_t size() const { return points.size(); }
  void add(const Vec3& point, const Vec3& normal) {
    points.push_back(point);
    normals.push_back(normal);
  }
};

}  // namespace vantage
