#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// One measurement of any depth sensor in world coordinates: a ray that either met a surface or met nothing.
struct SightLine {
  Vec3 origin;
  Vec3 direction;   // not normalised; t counts in units of its length
  double near = 0;  // t from which on the sensor sees
  double end = 0;   // t of the hit, or of the far limit where nothing was met
  bool is_hit = false;
  Vec3 normal = Vec3::Zero();  // of the surface at the hit, facing the sensor; zero where unknown
  double quality = 0;          // cosine between the normal and the direction back (QualityReference)

  [[nodiscard]] Vec3 hit_point() const { return origin + end * direction; }
};

/// Direction of ray (x, y, 1) of a view in world coordinates; every path computes it by this expression.
[[nodiscard]] inline Vec3 ray_direction(const Mat3& world_from_sensor, double x, double y) {
  return world_from_sensor.col(0) * x + world_from_sensor.col(1) * y + world_from_sensor.col(2);
}

/// What the quality of a point is measured against (spec, section 1).
enum class QualityReference { axis, ray };

/// Cosine between a point's normal and the direction back along `towards` (the viewing axis or the ray, a unit vector);
/// 0 where the surface faces away.
[[nodiscard]] inline double point_quality(const Vec3& normal, const Vec3& towards) {
  return std::max(0.0, -normal.dot(towards));
}

/// A scan by a sensor without a pinhole (line scanners): points in the sensor frame with the origins of their sight
/// lines.
struct PointScan {
  std::vector<Vec3> points;
  std::vector<Vec3f> normals;  // facing the sensor; empty or one per point, zero where unknown
  std::vector<Vec3> origins;   // one for all points or one per point
  Vec3 axis = Vec3::UnitZ();   // viewing axis in the sensor frame
};

/// The measurements of a scan from a view, unknown pixels left out, row by row. Hits beyond the camera's far limit
/// count as hits; no-returns end at the far limit.
[[nodiscard]] std::vector<SightLine> sight_lines(const RangeImage& image, std::span<const Vec3f> normals_in_sensor,
                                                 const View& view, QualityReference reference = QualityReference::axis);
[[nodiscard]] std::vector<SightLine> sight_lines(const PointScan& scan, const View& view,
                                                 QualityReference reference = QualityReference::axis);

}  // namespace vantage
