#include "vantage/core/error.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {

std::vector<Hypothesis> mirrored_worlds(const Reading& base) {
  std::vector<Hypothesis> hypotheses;
  for (int axis = 0; axis < 3; ++axis) {
    Hypothesis each{"rotation", {}, {}, base};
    Mat3 mirror = Mat3::Identity();
    mirror(axis, axis) = -1;
    for (Pose& pose : each.reading.world_from_sensor) {
      pose.linear() = mirror * pose.linear() * mirror;
      pose.translation() = mirror * pose.translation();
    }
    each.wrong = concat("the poses are those of a left-handed frame: its ", "xyz"[axis], " axes point the other way");
    each.fix = concat("negate the ", "xyz"[axis], " row and the ", "xyz"[axis], " column of every 4x4 matrix (",
                      "xyz"[axis], " of the position included)");
    hypotheses.push_back(std::move(each));
  }
  return hypotheses;
}

}  // namespace vantage
