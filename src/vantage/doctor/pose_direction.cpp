#include "vantage/doctor/hypothesis.hpp"

namespace vantage {

std::vector<Hypothesis> inverted_poses(const Reading& base) {
  Hypothesis inverted{"pose-direction", "the poses are camera from world; they must be world from camera",
                      "invert every 4x4 matrix before it is written", base};
  for (Pose& pose : inverted.reading.world_from_sensor) pose = pose.inverse();
  return {inverted};
}

}  // namespace vantage
