#include "vantage/doctor/reading.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vantage/core/geometry.hpp"

namespace vantage {

Reading as_given(const Evidence& evidence) {
  Reading reading;
  reading.world_from_sensor = evidence.poses();
  return reading;
}

PointCloud points_of(const FrameEvidence& frame, const Reading& reading) {
  Mat3 sheared = Mat3::Identity();
  sheared.diagonal().head<2>() = reading.tangent_scale;
  sheared.block<2, 1>(0, 2) = reading.tangent_shift;
  const Mat3 normal_matrix = sheared.inverse().transpose();
  PointCloud cloud;
  for (std::size_t i = 0; i < frame.cloud.size(); ++i) {
    // Where the surface is not known a normal is zero, and stays so; of disparities taken for depths none is known.
    const bool is_known = reading.kind != DepthKind::disparity;
    cloud.add(reading.point_of(frame.cloud.points[i]),
              is_known ? Vec3((normal_matrix * frame.cloud.normals[i]).normalized()) : Vec3(Vec3::Zero()));
  }
  return cloud;
}

bool stays_in_place(const Evidence& evidence, const Reading& reading) {
  constexpr double hardly = 0.02;  // of the depth
  constexpr double turned = radians(20);
  const Pose& first = reading.world_from_sensor.front();
  double moved = 0, angle = 0;
  for (const Pose& pose : reading.world_from_sensor) {
    moved = std::max(moved, (pose.translation() - first.translation()).norm());
    angle = std::max(angle, rotation_angle(pose.linear(), first.linear()));
  }
  const double depth = reading.depth_of(evidence.median_depth(), Eigen::Vector2d::Zero());
  return moved < hardly * depth && angle > turned;
}

}  // namespace vantage
