#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "vantage/arm/arm_kinematics.hpp"
#include "vantage/robot/robot_model.hpp"

namespace vantage {

struct ArmOptions {
  Pose world_from_base = Pose::Identity();
  Eigen::VectorXd home;                 // joints before the first move, radians or metres; all 0 where it is empty
  Eigen::VectorXd weights;              // what a radian or metre of each joint costs; all 1 where it is empty
  double padding = 0.01;                // metres that solids are grown by; see ArmCollision
  std::uint64_t seed = 1;               // of the search for paths
  int most_nodes = 2000;                // of that search before it gives up
  std::size_t most_remembered = 20000;  // views whose joints are kept, so that they are computed once
  std::vector<std::pair<std::string, std::string>> may_touch = {};  // links, besides those that a joint connects

  void validate(std::size_t joints) const;
};

/// An arm that carries the sensor. A view is reachable where joints within their limits bring the sensor there and the
/// arm touches neither itself nor anything that is not known to be free. A move is a path of the joints on which the
/// same holds everywhere; it costs the length of the path in the space of the weighted joints.
class Arm : public RobotModel {
 public:
  /// Throws InputError where the options do not fit the arm, or where it touches itself at home.
  explicit Arm(ArmDescription arm, const ArmOptions& options = {});

  [[nodiscard]] std::unique_ptr<Mobility> among(const Surroundings& surroundings) const override;
  [[nodiscard]] std::optional<RobotState> home() const override;
  /// Of all joints that hold the sensor there without the arm touching itself, those nearest to home.
  [[nodiscard]] std::optional<RobotState> state_at(const View& view) const override;
  [[nodiscard]] std::string cost_unit() const override { return "rad"; }

  [[nodiscard]] const ArmKinematics& kinematics() const { return kinematics_; }
  [[nodiscard]] const ArmOptions& options() const { return options_; }
  /// ArmKinematics::inverse, remembered for the views that were asked for last: candidates are, again and again.
  [[nodiscard]] std::shared_ptr<const std::vector<Eigen::VectorXd>> inverse(const View& view) const;
  /// Of how many views the joints are remembered.
  [[nodiscard]] std::size_t remembered() const;

 private:
  ArmKinematics kinematics_;
  ArmOptions options_;
  using Memory = std::map<std::array<double, 12>, std::shared_ptr<const std::vector<Eigen::VectorXd>>>;
  void remember(const std::array<double, 12>& key, std::shared_ptr<const std::vector<Eigen::VectorXd>> joints) const;

  mutable std::mutex remembering_;
  // When the first is full it becomes the second, and what nobody asked for meanwhile is forgotten.
  mutable Memory recent_, older_;
};

}  // namespace vantage
