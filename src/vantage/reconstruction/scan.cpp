#include "vantage/reconstruction/scan.hpp"

namespace vantage {
namespace {

PointCloud points_of_image(const ImageScan& scan) {
  const RayGrid rays = scan.image.camera.rays();
  PointCloud cloud;
  std::size_t pixel = 0;
  for (int row = 0; row < rays.resolution.rows; ++row) {
    for (int column = 0; column < rays.resolution.columns; ++column, ++pixel) {
      const float depth = scan.image.depth[pixel];
      if (!RangeImage::is_hit(depth)) continue;
      cloud.add(point_in_sensor(rays, column, row, static_cast<double>(depth)), scan.normals[pixel].cast<double>());
    }
  }
  return cloud;
}

PointCloud points_of_lines(const PointScan& scan) {
  PointCloud cloud;
  cloud.points = scan.points;
  cloud.normals.assign(scan.points.size(), Vec3::Zero());
  for (std::size_t i = 0; i < scan.normals.size(); ++i) cloud.normals[i] = scan.normals[i].cast<double>();
  return cloud;
}

}  // namespace

Scan scan_of(RangeImage image) {
  image.validate();
  std::vector<Vec3f> normals = range_image_normals(image);
  return ImageScan{std::move(image), std::move(normals)};
}

PointCloud points_of(const Scan& scan) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) return points_of_image(*image);
  return points_of_lines(std::get<PointScan>(scan));
}

IntegrationReport integrate(VoxelMap& map, const Scan& scan, const View& view, QualityReference reference) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    return integrate(map, image->image, image->normals, view, reference);
  }
  return integrate_exactly(map, sight_lines(std::get<PointScan>(scan), view, reference));
}

}  // namespace vantage
