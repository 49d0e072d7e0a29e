#include "vantage/sensor/sight_line.hpp"

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

void set_surface(SightLine& line, const Vec3& normal, const Vec3& axis, QualityReference reference) {
  line.normal = normal;
  const Vec3 towards = reference == QualityReference::axis ? axis : Vec3(line.direction.normalized());
  line.quality = point_quality(normal, towards);
}

}  // namespace

std::vector<SightLine> sight_lines(const RangeImage& image, std::span<const Vec3f> normals_in_sensor, const View& view,
                                   QualityReference reference) {
  image.validate();
  require(normals_in_sensor.empty() || normals_in_sensor.size() == image.depth.size(),
          "sight lines: ", normals_in_sensor.size(), " normals for ", image.depth.size(), " pixels");
  const RayGrid rays = image.camera.rays();
  const Mat3 rotation = view.world_from_sensor.linear();
  std::vector<SightLine> lines;
  lines.reserve(image.depth.size());
  std::size_t pixel = 0;
  for (int row = 0; row < rays.resolution.rows; ++row) {
    for (int column = 0; column < rays.resolution.columns; ++column, ++pixel) {
      const float depth = image.depth[pixel];
      if (!(depth > 0)) continue;
      SightLine line;
      line.origin = view.position();
      line.direction = ray_direction(rotation, rays.x(column), rays.y(row));
      line.near = image.camera.min_depth;
      line.is_hit = RangeImage::is_hit(depth);
      line.end = line.is_hit ? static_cast<double>(depth) : image.camera.max_depth;
      if (line.is_hit && !normals_in_sensor.empty()) {
        const Vec3 normal = normals_in_sensor[pixel].cast<double>();
        if (!normal.isZero(0)) set_surface(line, rotation * normal, view.axis(), reference);
      }
      lines.push_back(line);
    }
  }
  return lines;
}

std::vector<SightLine> sight_lines(const PointScan& scan, const View& view, QualityReference reference) {
  require(scan.origins.size() == 1 || scan.origins.size() == scan.points.size(), "point scan: ", scan.origins.size(),
          " sight-line origins for ", scan.points.size(), " points; must be one, or one per point");
  require(scan.normals.empty() || scan.normals.size() == scan.points.size(), "point scan: ", scan.normals.size(),
          " normals for ", scan.points.size(), " points");
  const Mat3 rotation = view.world_from_sensor.linear();
  const Vec3 axis = rotation * scan.axis;
  std::vector<SightLine> lines;
  lines.reserve(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    SightLine line;
    line.origin = view.world_from_sensor * scan.origins[scan.origins.size() == 1 ? 0 : i];
    line.direction = view.world_from_sensor * scan.points[i] - line.origin;
    if (!(line.direction.norm() > 1e-12)) continue;  // a point at its own origin says nothing
    line.end = 1;
    line.is_hit = true;
    if (!scan.normals.empty() && !scan.normals[i].isZero(0)) {
      set_surface(line, rotation * scan.normals[i].cast<double>(), axis, reference);
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace vantage
