#include "vantage/map/sensor_distance.hpp"

#include "vantage/core/error.hpp"

namespace vantage {

void require_near(const Grid& grid, const Vec3& sensor) {
  constexpr double most_voxels = 0.5 * Grid::farthest_index;
  const double voxels = (sensor - grid.min).cwiseAbs().maxCoeff() / grid.length;
  require(voxels < most_voxels, "scan: the sensor at ", sensor.transpose(), " m is ", voxels,
          " voxels away from the map, must be less than ", most_voxels);
}

}  // namespace vantage
