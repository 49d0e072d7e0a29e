#include "vantage/doctor/hypothesis.hpp"

namespace vantage {

std::vector<Hypothesis> misread_rotations(const Reading& base) {
  Hypothesis w_first{"rotation", "the quaternions have w first: they were read as x y z w, but are w x y z",
                     "write quaternions as x y z w", base};
  for (Pose& pose : w_first.reading.world_from_sensor) {
    const Eigen::Quaterniond read(Mat3(pose.linear()));
    pose.linear() = Eigen::Quaterniond(read.x(), read.y(), read.z(), read.w()).toRotationMatrix();
  }
  Hypothesis transposed{
      "rotation", "the rotations are transposed (row by row is taken for column by column), the positions are not",
      "transpose the upper left 3x3 numbers of every matrix", base};
  for (Pose& pose : transposed.reading.world_from_sensor) pose.linear() = Mat3(pose.linear().transpose());
  return {w_first, transposed};
}

}  // namespace vantage
