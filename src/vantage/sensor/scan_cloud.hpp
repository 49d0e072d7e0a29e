#pragma once

#include <span>

#include "vantage/core/point_cloud.hpp"
#include "vantage/sensor/range_image.hpp"

namespace vantage {

/// The measured points of a range image with their normals, sensor frame, row by row. Throws InputError unless there is
/// one normal per pixel.
[[nodiscard]] PointCloud scan_cloud(const RangeImage& image, std::span<const Vec3f> normals_in_sensor);

}  // namespace vantage
