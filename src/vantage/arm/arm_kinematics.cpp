#include "vantage/arm/arm_kinematics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

constexpr double tolerance = 1e-7;  // metres and radians
constexpr int most_steps = 60;      // of one start
constexpr int most_starts = 120;
constexpr int most_fruitless_starts = 24;
constexpr double turn = 2 * std::numbers::pi;

Pose motion(const ArmJoint& joint, double position) {
  if (joint.kind == ArmJoint::Kind::prismatic) return Pose(Eigen::Translation3d(position * joint.axis));
  return Pose(Eigen::AngleAxisd(position, joint.axis));
}

/// The farthest that a point of a shape is from the origin of its joint's frame.
double farthest_point(const LinkShape& shape) {
  const double half = shape.kind == LinkShape::Kind::box        ? shape.size.norm() / 2
                      : shape.kind == LinkShape::Kind::cylinder ? std::hypot(shape.size.x(), shape.size.y() / 2)
                                                                : shape.size.x();
  return shape.joint_from_shape.translation().norm() + half;
}

Eigen::VectorXd reach_of(const ArmDescription& arm) {
  const auto count = static_cast<int>(arm.joints.size());
  Eigen::VectorXd reach = Eigen::VectorXd::Ones(count);
  for (int j = 0; j < count; ++j) {
    if (arm.joints[static_cast<std::size_t>(j)].kind == ArmJoint::Kind::prismatic) continue;
    double farthest = 0;
    double to_frame = 0;  // longest way from joint j to the frame of joint k, whatever the joints in between do
    for (int k = j; k < count; ++k) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(k)];
      if (k > j) to_frame += joint.previous_from_joint.translation().norm();
      if (joint.kind == ArmJoint::Kind::prismatic) to_frame += std::max(std::abs(joint.lower), std::abs(joint.upper));
      for (const ArmBody& body : arm.bodies) {
        if (body.joint != k) continue;
        for (const LinkShape& shape : body.shapes) farthest = std::max(farthest, to_frame + farthest_point(shape));
      }
    }
    reach[j] = farthest;
  }
  return reach;
}

}  // namespace

ArmKinematics::ArmKinematics(ArmDescription arm, const Pose& world_from_base)
    : arm_(std::move(arm)), world_from_base_(world_from_base), reach_(reach_of(arm_)) {}

bool ArmKinematics::within_limits(const Eigen::VectorXd& joints) const {
  for (Eigen::Index j = 0; j < joints.size(); ++j) {
    const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(j)];
    if (joints[j] < joint.lower || joints[j] > joint.upper) return false;
  }
  return true;
}

std::vector<Pose> ArmKinematics::world_from_joints(const Eigen::VectorXd& joints) const {
  std::vector<Pose> frames;
  frames.reserve(arm_.joints.size());
  Pose frame = world_from_base_;
  for (std::size_t j = 0; j < arm_.joints.size(); ++j) {
    frame = frame * arm_.joints[j].previous_from_joint * motion(arm_.joints[j], joints[static_cast<Eigen::Index>(j)]);
    frames.push_back(frame);
  }
  return frames;
}

Pose ArmKinematics::world_from_sensor(const Eigen::VectorXd& joints) const {
  return world_from_joints(joints).back() * arm_.last_from_sensor;
}

ArmKinematics::Twist ArmKinematics::error(const Pose& at, const Pose& goal) const {
  const Eigen::AngleAxisd rotation(Mat3(goal.linear() * at.linear().transpose()));
  Twist twist;
  twist << goal.translation() - at.translation(), rotation.angle() * rotation.axis();
  return twist;
}

/// Levenberg's method: steps that lower the error are taken and trusted more, others are shortened.
bool ArmKinematics::solve(const Pose& goal, Eigen::VectorXd& joints) const {
  double damping = 0.1;
  Twist off = error(world_from_sensor(joints), goal);
  for (int step = 0; step < most_steps; ++step) {
    if (off.cwiseAbs().maxCoeff() < tolerance) return true;
    const std::vector<Pose> frames = world_from_joints(joints);
    const Vec3 sensor = frames.back() * arm_.last_from_sensor.translation();
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, joints.size());
    for (Eigen::Index j = 0; j < joints.size(); ++j) {
      const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(j)];
      const Pose& frame = frames[static_cast<std::size_t>(j)];
      const Vec3 axis = frame.linear() * joint.axis;
      if (joint.kind == ArmJoint::Kind::revolute) {
        jacobian.col(j) << axis.cross(sensor - frame.translation()), axis;
      } else {
        jacobian.col(j) << axis, Vec3::Zero();
      }
    }
    const Eigen::Matrix<double, 6, 6> normal =
        jacobian * jacobian.transpose() + damping * damping * Eigen::Matrix<double, 6, 6>::Identity();
    const Eigen::VectorXd next = joints + jacobian.transpose() * normal.ldlt().solve(off);
    const Twist next_off = error(world_from_sensor(next), goal);
    if (next_off.norm() < off.norm()) {
      joints = next;
      off = next_off;
      damping = std::max(1e-6, damping / 4);
    } else {
      damping *= 3;
      if (damping > 1e3) return false;
    }
  }
  return off.cwiseAbs().maxCoeff() < tolerance;
}

Eigen::VectorXd ArmKinematics::nearest_turns(const Eigen::VectorXd& joints, const Eigen::VectorXd& reference) const {
  Eigen::VectorXd nearest = joints;
  for (Eigen::Index j = 0; j < joints.size(); ++j) {
    const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(j)];
    if (joint.kind == ArmJoint::Kind::prismatic) continue;
    double value = joints[j] + turn * std::round((reference[j] - joints[j]) / turn);
    if (value < joint.lower) value += turn * std::ceil((joint.lower - value) / turn);
    if (value > joint.upper) value -= turn * std::ceil((value - joint.upper) / turn);
    nearest[j] = value;
  }
  return nearest;
}

std::vector<Eigen::VectorXd> ArmKinematics::inverse(const Pose& goal) const {
  std::vector<Eigen::VectorXd> found;
  Random random(1);
  const Eigen::VectorXd middle = Eigen::VectorXd::Zero(joints());
  int fruitless = 0;
  for (int start = 0; start < most_starts && fruitless < most_fruitless_starts; ++start, ++fruitless) {
    Eigen::VectorXd solution(joints());
    for (Eigen::Index j = 0; j < joints(); ++j) {
      const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(j)];
      const bool turns = joint.kind == ArmJoint::Kind::revolute;
      solution[j] = random.uniform(turns ? std::max(joint.lower, -std::numbers::pi) : joint.lower,
                                   turns ? std::min(joint.upper, std::numbers::pi) : joint.upper);
    }
    if (!solve(goal, solution)) continue;
    solution = nearest_turns(solution, middle);
    if (!within_limits(solution)) continue;
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const Eigen::VectorXd& other) {
      return (nearest_turns(other, solution) - solution).cwiseAbs().maxCoeff() < 1e-3;
    });
    if (is_known) continue;
    found.push_back(std::move(solution));
    fruitless = 0;
  }
  return found;
}

}  // namespace vantage
