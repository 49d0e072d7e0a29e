#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>
#include <string>

namespace vantage {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;
/// A rigid motion, named `b_from_a`: it takes coordinates in frame a to coordinates in frame b. Metres.
using Pose = Eigen::Isometry3d;
/// A voxel's place in a grid.
using Index3 = Eigen::Vector3i;
using Box3 = Eigen::AlignedBox3d;

/// An axis-aligned block of voxels, both ends inclusive.
struct IndexBox {
  Index3 min = Index3::Zero();
  Index3 max = Index3::Constant(-1);

  [[nodiscard]] Index3 size() const { return max - min + Index3::Ones(); }
  [[nodiscard]] bool contains(const Index3& index) const {
    return (index.array() >= min.array()).all() && (index.array() <= max.array()).all();
  }
};

[[nodiscard]] constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }
[[nodiscard]] constexpr double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// The pose of a sensor (x right, y down, z forward) at `position` that looks at `target`. Up is +z, or +y where the
/// viewing direction is within 2.6 degrees of the z axis (|axis.z| > 0.999). Throws InputError where both points
/// coincide.
[[nodiscard]] Pose look_at(const Vec3& position, const Vec3& target);

/// The angle of the rotation between two orientations, in radians.
[[nodiscard]] double rotation_angle(const Mat3& a, const Mat3& b);

/// Throws InputError naming `what` unless the 4x4 matrix is a proper rigid motion (finite, orthonormal, not mirrored,
/// last row 0 0 0 1) within `tolerance`; otherwise returns it with its rotation orthonormalised.
[[nodiscard]] Pose rigid_pose(const Eigen::Matrix4d& matrix, const std::string& what, double tolerance = 1e-3);

}  // namespace vantage
