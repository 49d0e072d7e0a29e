#pragma once

#include <string>
#include <vector>

#include "vantage/doctor/reading.hpp"

namespace vantage {

/// A mistake that could have been made, and the frames read as if it had been.
struct Hypothesis {
  std::string check;
  std::string wrong;  // what would be wrong
  std::string fix;    // what to do about it
  Reading reading;    // as the mistake fixed
};

// Each check proposes the mistakes that it knows; the doctor asks which of all explains the frames best. `base` is the
// reading that they change.

/// Depths in another unit: `depth_scale` is the scale that they were read with, metres per unit. Only those that make
/// depths what sensors of objects measure.
[[nodiscard]] std::vector<Hypothesis> depth_units(const Reading& base, const Evidence& evidence, double depth_scale);
/// Positions in another unit than metres, where depths are what sensors measure as they are read.
[[nodiscard]] std::vector<Hypothesis> position_units(const Reading& base, const Evidence& evidence);
/// Distances along the ray instead of depths.
[[nodiscard]] std::vector<Hypothesis> distances(const Reading& base, const Evidence& evidence);
/// Disparities instead of depths, with the constant that fits best.
[[nodiscard]] std::vector<Hypothesis> disparities(const Reading& base, const Evidence& evidence);
/// Camera from world instead of world from camera.
[[nodiscard]] std::vector<Hypothesis> inverted_poses(const Reading& base);
/// Camera axes other than x right, y down, z forward: those that are in use, or all others.
[[nodiscard]] std::vector<Hypothesis> usual_axes(const Reading& base);
[[nodiscard]] std::vector<Hypothesis> unusual_axes(const Reading& base);
/// Both: camera from world, and other axes.
[[nodiscard]] std::vector<Hypothesis> inverted_poses_of_usual_axes(const Reading& base);
/// Quaternions with w first, and rotations that are transposed while positions are not.
[[nodiscard]] std::vector<Hypothesis> misread_rotations(const Reading& base);
/// Poses of a left-handed world, whose rotations are proper all the same.
[[nodiscard]] std::vector<Hypothesis> mirrored_worlds(const Reading& base);
/// Poses of other frames, some places later or earlier; of frames of which only every n-th is looked at.
[[nodiscard]] std::vector<Hypothesis> shifted_times(const Reading& base, std::size_t every);
/// Intrinsics with cx and cy swapped, or of images of another size. Empty without a pinhole camera.
[[nodiscard]] std::vector<Hypothesis> other_intrinsics(const Reading& base, const Evidence& evidence);
/// Poses of the robot's hand, with the pose of the sensor in it estimated, as far as the frames say it. Empty where no
/// pose of it is found. Takes seconds.
[[nodiscard]] std::vector<Hypothesis> poses_of_the_hand(const Reading& base, const Evidence& evidence);

}  // namespace vantage
