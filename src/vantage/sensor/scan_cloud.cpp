#include "vantage/sensor/scan_cloud.hpp"

#include "vantage/core/error.hpp"

namespace vantage {

PointCloud scan_cloud(const RangeImage& image, std::span<const Vec3f> normals_in_sensor) {
  require(normals_in_sensor.size() == image.depth.size(), "scan: ", normals_in_sensor.size(), " normals for ",
          image.depth.size(), " pixels; must be as many");
  const RayGrid rays = image.camera.rays();
  PointCloud cloud;
  std::size_t pixel = 0;
  for (int row = 0; row < image.camera.resolution.rows; ++row) {
    for (int column = 0; column < image.camera.resolution.columns; ++column, ++pixel) {
      const float depth = image.depth[pixel];
      if (!RangeImage::is_hit(depth)) continue;
      cloud.add(point_in_sensor(rays, column, row, static_cast<double>(depth)),
                normals_in_sensor[pixel].cast<double>());
    }
  }
  return cloud;
}

}  // namespace vantage
