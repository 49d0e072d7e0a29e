#pragma once

#include <optional>
#include <vector>

#include "vantage/doctor/agreement.hpp"

namespace vantage {

/// What one frame saw, as a map from directions to depths; for frames of any sensor with one origin.
class SightMap {
 public:
  /// Points in the sensor's frame, z forward.
  explicit SightMap(const std::vector<Vec3>& points);
  /// The least depth that was met around the direction of a point (sensor frame); 0 where not all around it is known.
  [[nodiscard]] double least_depth(const Vec3& point) const;

 private:
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero();  // tangents x/z, y/z of the corner
  double cell_ = 1;                                  // tangents
  int columns_ = 0, rows_ = 0;
  std::vector<float> least_;  // of the cell and its eight neighbours
};

/// A frame that fits the others better in another place.
struct Misplaced {
  std::size_t frame = 0;
  Vec3 offset = Vec3::Zero();             // metres, world: how far it seems to be from where it belongs
  double before = 0, after = 0;           // share of its points that lie where others see through, and the other way
  double agreement = 0, agreed_then = 0;  // agreement_of_frames() of it, here and there
};

/// Frames whose points float where others see through (or hide what others see), and that stop to do so where they are
/// moved by at least twice `pose_error`, without sharing less with the others there. So a frame is found that was
/// shifted along a table or a wall, which shares as much of that as before.
[[nodiscard]] std::vector<Misplaced> misplaced_frames(const Evidence& evidence, const Reading& reading,
                                                      double pose_error);

}  // namespace vantage
