#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "vantage/arm/arm_description.hpp"

namespace vantage {

/// Where the parts of an arm are for given joints, and which joints bring its sensor to a pose.
class ArmKinematics {
 public:
  ArmKinematics(ArmDescription arm, const Pose& world_from_base);

  [[nodiscard]] const ArmDescription& arm() const { return arm_; }
  [[nodiscard]] Eigen::Index joints() const { return static_cast<Eigen::Index>(arm_.joints.size()); }
  [[nodiscard]] bool within_limits(const Eigen::VectorXd& joints) const;
  /// The pose of every joint's frame, moved with the joint.
  [[nodiscard]] std::vector<Pose> world_from_joints(const Eigen::VectorXd& joints) const;
  [[nodiscard]] Pose world_from_sensor(const Eigen::VectorXd& joints) const;
  [[nodiscard]] const Pose& world_from_base() const { return world_from_base_; }

  /// Joints within their limits that bring the sensor to the pose, to a micrometre and a microradian: damped least
  /// squares from many starts, the same ones every time, until new starts bring nothing new. Different ones only: turns
  /// of 360 degrees count as the same. Empty where none is found.
  [[nodiscard]] std::vector<Eigen::VectorXd> inverse(const Pose& world_from_sensor) const;
  /// The same place of the arm with each revolute joint turned by whole turns as near to `reference` as limits allow.
  [[nodiscard]] Eigen::VectorXd nearest_turns(const Eigen::VectorXd& joints, const Eigen::VectorXd& reference) const;

  /// For each joint, how far its motion by one unit can move any point of the arm: 1 for prismatic joints, the largest
  /// distance of a solid from the axis for revolute ones, metres.
  [[nodiscard]] const Eigen::VectorXd& reach_of_joints() const { return reach_; }

 private:
  using Twist = Eigen::Matrix<double, 6, 1>;
  [[nodiscard]] Twist error(const Pose& at, const Pose& goal) const;
  [[nodiscard]] bool solve(const Pose& goal, Eigen::VectorXd& joints) const;

  ArmDescription arm_;
  Pose world_from_base_;
  Eigen::VectorXd reach_;
};

}  // namespace vantage
