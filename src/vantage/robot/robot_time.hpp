#pragma once

namespace vantage {

/// What a robot's time goes into.
struct RobotTime {
  double scan = 3;     // seconds per scan
  double speed = 0.5;  // metres per second

  [[nodiscard]] double seconds(double metres) const { return scan + metres / speed; }
  /// Throws InputError naming the option.
  void validate() const;
};

}  // namespace vantage
