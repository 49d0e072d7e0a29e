#pragma once

#include <cmath>
#include <vector>

#include "vantage/doctor/evidence.hpp"

namespace vantage {

/// What the numbers of depth images may be.
enum class DepthKind { depth, distance, disparity };

/// One way to read a set of frames: what is given may be taken for something else than it says.
struct Reading {
  std::vector<Pose> world_from_sensor;  // one per frame
  /// Of the depths as read; of a disparity: depth times value.
  double depth_scale = 1;
  DepthKind kind = DepthKind::depth;
  /// Tangents of the pixels become scale * tangent + shift, per axis.
  Eigen::Vector2d tangent_scale{1, 1}, tangent_shift{0, 0};

  /// The depth, metres, of a pixel with this (true) tangent that was read as `depth`.
  [[nodiscard]] double depth_of(double depth, const Eigen::Vector2d& tangent) const {
    if (kind == DepthKind::disparity) return depth_scale / depth;
    const double scaled = depth_scale * depth;
    return kind == DepthKind::distance ? scaled / std::sqrt(1 + tangent.squaredNorm()) : scaled;
  }
  /// The point, metres, that was read as `point`.
  [[nodiscard]] Vec3 point_of(const Vec3& point) const {
    const Eigen::Vector2d tangent = tangent_scale.cwiseProduct(point.head<2>() / point.z()) + tangent_shift;
    const double depth = depth_of(point.z(), tangent);
    return {tangent.x() * depth, tangent.y() * depth, depth};
  }
};

/// The reading that takes everything as it is given.
[[nodiscard]] Reading as_given(const Evidence& evidence);

/// The points and normals of a frame in that reading, sensor frame, metres. Normals are those of the surface as read
/// with its tangents changed.
[[nodiscard]] PointCloud points_of(const FrameEvidence& frame, const Reading& reading);

/// Whether the sensor turns but stays where it is, which a reading of good frames can look like too.
[[nodiscard]] bool stays_in_place(const Evidence& evidence, const Reading& reading);

}  // namespace vantage
