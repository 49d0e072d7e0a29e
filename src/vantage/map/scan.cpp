#include "vantage/map/scan.hpp"

#include "vantage/sensor/scan_cloud.hpp"

namespace vantage {
namespace {

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
  if (const auto* image = std::get_if<ImageScan>(&scan)) return scan_cloud(image->image, image->normals);
  return points_of_lines(std::get<PointScan>(scan));
}

IntegrationReport integrate(VoxelMap& map, const Scan& scan, const View& view, QualityReference reference) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    return integrate(map, image->image, image->normals, view, reference);
  }
  return integrate_exactly(map, sight_lines(std::get<PointScan>(scan), view, reference));
}

}  // namespace vantage
