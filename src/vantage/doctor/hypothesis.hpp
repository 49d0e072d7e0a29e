#pragma once

#include <string>
#include <vector>

#include "vantage/doctor/agreement.hpp"

namespace vantage {

/// A mistake that could have been made, and the frames read as if it had been.
struct Hypothesis {
  std::string check;
  std::string wrong;  // what would be wrong
  std::string mend;   // what to do about it
  Reading reading;    // as the mistake mended
};

// Each check proposes the mistakes that it knows; the doctor asks which of all explains the frames best. `base` is the
// reading that they change.

/// Depths in another unit: `depth_scale` is the scale that they were read with, metres per unit.
[[nodiscard]] std::vector<Hypothesis> depth_units(const Reading& base, double depth_scale);
/// Camera from world instead of world from camera.
[[nodiscard]] std::vector<Hypothesis> inverted_poses(const Reading& base);
/// Camera axes other than x right, y down, z forward.
[[nodiscard]] std::vector<Hypothesis> other_axes(const Reading& base);
/// Poses of a left-handed world, whose rotations are proper all the same.
[[nodiscard]] std::vector<Hypothesis> mirrored_worlds(const Reading& base);
/// Poses of other frames, some places later or earlier.
[[nodiscard]] std::vector<Hypothesis> shifted_times(const Reading& base);
/// Intrinsics of images of another size. Empty without a pinhole camera.
[[nodiscard]] std::vector<Hypothesis> other_resolutions(const Reading& base, const Evidence& evidence);

}  // namespace vantage
