#pragma once

#include <variant>

#include "vantage/core/point_cloud.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {

/// A range image with the normals of its points (one per pixel, sensor frame).
struct ImageScan {
  RangeImage image;
  std::vector<Vec3f> normals;
};

/// One scan of any depth sensor, in its own frame.
using Scan = std::variant<ImageScan, PointScan>;

/// Computes the normals of the image's points.
[[nodiscard]] Scan scan_of(RangeImage image);

/// The measured points with their normals, sensor frame. Points beyond the depth limits of a camera are left out.
[[nodiscard]] PointCloud points_of(const Scan& scan);

/// Updates the map's labels with a scan taken from `view`.
IntegrationReport integrate(VoxelMap& map, const Scan& scan, const View& view,
                            QualityReference reference = QualityReference::axis);

}  // namespace vantage
