#pragma once

#include "vantage/robot/robot_model.hpp"
#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Whatever carries the sensor: an arm, a drone, a person, a simulation.
class Robot {
 public:
  Robot() = default;
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  virtual ~Robot() = default;

  /// Moves the sensor towards `view`; false where it turns out that the robot cannot get there. Where it ends up may
  /// differ from `view` without the robot's knowledge.
  [[nodiscard]] virtual bool move_to(const View& view) = 0;
  /// Moves along a path that was planned with the robot's model; false as with move_to. A robot that finds its own way
  /// goes for the end of it.
  [[nodiscard]] virtual bool follow(const Move& move) { return move_to(move.path.back().view); }
  /// Scans from where the sensor is.
  [[nodiscard]] virtual RangeImage take_range_image() = 0;
  /// Where the robot believes the sensor to be.
  [[nodiscard]] virtual View view() const = 0;
};

}  // namespace vantage
