#include "vantage/robot/robot_time.hpp"

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {

void RobotTime::validate() const {
  require(scan >= 0 && std::isfinite(scan), "scan-time = ", scan, " s: must not be negative");
  require(speed > 0 && std::isfinite(speed), "speed = ", speed, " m/s: must be positive");
}

}  // namespace vantage
