#include "vantage/core/geometry.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {

Pose look_at(const Vec3& position, const Vec3& target) {
  const Vec3 offset = target - position;
  require(offset.norm() > 1e-9, "look_at: the position and the target are the same point (", position.transpose(), ")");
  const Vec3 axis = offset.normalized();
  const Vec3 up = std::abs(axis.z()) > 0.999 ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 right = axis.cross(up).normalized();
  const Vec3 down = axis.cross(right);
  Pose world_from_sensor = Pose::Identity();
  world_from_sensor.linear() << right, down, axis;
  world_from_sensor.translation() = position;
  return world_from_sensor;
}

double rotation_angle(const Mat3& a, const Mat3& b) {
  // The sine from the antisymmetric part keeps small angles exact where the cosine has lost them.
  const Mat3 difference = a.transpose() * b;
  const Vec3 twice_sine(difference(2, 1) - difference(1, 2), difference(0, 2) - difference(2, 0),
                        difference(1, 0) - difference(0, 1));
  return std::atan2(0.5 * twice_sine.norm(), 0.5 * (difference.trace() - 1));
}

Pose rigid_pose(const Eigen::Matrix4d& matrix, const std::string& what, double tolerance) {
  require(matrix.allFinite(), what, ": the pose has an entry that is not a finite number");
  const Eigen::RowVector4d last = matrix.row(3);
  require((last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= tolerance, what, ": the last row is ", last,
          ", must be 0 0 0 1 (is the matrix transposed?)");
  const Mat3 rotation = matrix.topLeftCorner<3, 3>();
  require(rotation.determinant() > 0, what, ": the rotation has determinant ", rotation.determinant(),
          ", it is mirrored (left-handed axes); must be +1");
  const double error = (rotation.transpose() * rotation - Mat3::Identity()).cwiseAbs().maxCoeff();
  require(error <= tolerance, what, ": the rotation is not orthonormal (off by ", error, ", determinant ",
          rotation.determinant(), "); a pose must be a rigid motion without scale");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Pose pose = Pose::Identity();
  // Leave what is already orthonormal to rounding alone, so that a pose survives being written and read.
  pose.linear() = error < 1e-14 ? rotation : Mat3(svd.matrixU() * svd.matrixV().transpose());
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

}  // namespace vantage
