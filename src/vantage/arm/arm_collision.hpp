#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "vantage/arm/arm_kinematics.hpp"
#include "vantage/robot/robot_model.hpp"

namespace vantage {

/// Whether an arm touches itself, the obstacles, or a voxel that is not known to be empty. Its solids are grown by a
/// padding, so that it keeps clear by twice that of itself and by once that of the rest. Safe to ask from several
/// threads.
class ArmCollision {
 public:
  /// `padding` in metres. The arm must outlive it.
  ArmCollision(const ArmKinematics& arm, double padding);
  /// The same among surroundings; links that do not move may touch them, as a base does that stands on a table.
  ArmCollision(const ArmKinematics& arm, double padding, const Surroundings& surroundings);
  ~ArmCollision();
  ArmCollision(const ArmCollision&) = delete;
  ArmCollision& operator=(const ArmCollision&) = delete;

  /// What touches what, or nothing.
  [[nodiscard]] std::optional<std::string> why_touching(const Eigen::VectorXd& joints) const;
  /// Whether the arm touches nothing while its joints move straight from one place to the other. It is asked at places
  /// between which no point of the arm moves by more than the padding on both sides makes up for, so that nothing in
  /// between is missed.
  [[nodiscard]] bool is_clear(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

 private:
  struct Solids;
  const ArmKinematics& arm_;
  double padding_;
  std::unique_ptr<Solids> solids_;
};

}  // namespace vantage
