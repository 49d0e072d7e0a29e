#pragma once

#include "vantage/robot/robot_model.hpp"

namespace vantage {

/// Three linear axes and a head that pans about z and tilts; it cannot roll.
struct GantryOptions {
  Box3 axes = Box3(Vec3(-1, -1, 0), Vec3(1, 1, 2));  // where the sensor can be, metres
  Eigen::Vector2d pan{-180, 180};                    // degrees, 0 looks along +x, 90 along +y
  Eigen::Vector2d tilt{-90, 90};                     // degrees above the horizon
  double head_radius = 0;                            // metres; a ball around the sensor
  double turn_cost = 0.1;                            // metres that a radian of pan or tilt counts as

  void validate() const;
};

/// A gantry. Joints: x, y, z in metres, pan and tilt in radians. A move costs the metres of its way plus `turn_cost`
/// times the larger of the two turns.
class Gantry : public RobotModel {
 public:
  /// Throws InputError naming the option.
  explicit Gantry(const GantryOptions& options);

  [[nodiscard]] std::unique_ptr<Mobility> among(const Surroundings& surroundings) const override;
  [[nodiscard]] std::optional<RobotState> state_at(const View& view) const override;
  [[nodiscard]] RobotState state_near(const View& view) const override;
  /// Why the axes do not get to the view, whatever stands around.
  [[nodiscard]] std::optional<std::string> why_beyond_limits(const View& view) const;
  /// Cost of a move whose way has this length.
  [[nodiscard]] double cost(double metres, const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;
  [[nodiscard]] const GantryOptions& options() const { return options_; }

 private:
  GantryOptions options_;
};

/// x, y, z, pan and tilt (radians) of a view that is not rolled.
[[nodiscard]] Eigen::VectorXd gantry_joints(const View& view);
/// The view behind these joints.
[[nodiscard]] View gantry_view(const Eigen::VectorXd& joints);

}  // namespace vantage
