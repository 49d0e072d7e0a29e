#pragma once

#include "vantage/robot/robot_model.hpp"

namespace vantage {

/// A table that turns the object about a vertical axis, and an arc above it on which the sensor rides. The frame is the
/// object's: the table stands still and the arc turns around it.
struct TurntableOptions {
  Vec3 center = Vec3::Zero();       // of the arc, which the sensor looks at; on the table's axis
  double radius = 1;                // of the arc, metres
  Eigen::Vector2d arc{0, 90};       // from where to where the sensor rides, degrees above the horizon
  Eigen::Vector2d turn{-180, 180};  // how far the table turns, degrees; -180 .. 180 turns without end
  double head_radius = 0;           // metres; a ball around the sensor
  double tolerance = 0.001;         // metres that a view may lie off the arc
  Eigen::Vector2d weights{1, 1};    // what a radian of the table, and of the arc, costs

  void validate() const;
};

/// A turntable. Joints: turn of the table and elevation on the arc, radians. A move costs the weighted sum of both.
class Turntable : public RobotModel {
 public:
  /// Throws InputError naming the option.
  explicit Turntable(const TurntableOptions& options);

  [[nodiscard]] std::unique_ptr<Mobility> among(const Surroundings& surroundings) const override;
  [[nodiscard]] std::optional<RobotState> state_at(const View& view) const override;
  [[nodiscard]] RobotState state_near(const View& view) const override;
  [[nodiscard]] std::string cost_unit() const override { return "rad"; }

  /// Why the arc does not get to the view, whatever stands around.
  [[nodiscard]] std::optional<std::string> why_beyond_limits(const View& view) const;
  /// Turn and elevation of a view on the arc.
  [[nodiscard]] Eigen::Vector2d joints_of(const View& view) const;
  [[nodiscard]] View view_of(const Eigen::Vector2d& joints) const;
  /// What is to be added to the joints: the shorter way round where the table turns without end.
  [[nodiscard]] Eigen::Vector2d difference(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  [[nodiscard]] const TurntableOptions& options() const { return options_; }

 private:
  TurntableOptions options_;
};

}  // namespace vantage
