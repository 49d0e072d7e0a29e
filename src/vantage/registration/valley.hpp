#pragma once

#include <span>
#include <vector>

#include "vantage/registration/pose_estimate.hpp"
#include "vantage/registration/scan_surface.hpp"

namespace vantage {

/// A motion of a scan at its place: by the distance that it moves the samples (RMS), in metres, at first.
struct ScanMotion {
  Vec6 step = Vec6::Zero();  // for small distances, per metre, in the order of pose_step()
  double deviation = 0;      // standard deviation of the distance, metres

  /// The pose after the motion has gone on for `distance`, along a straight line or about its axis.
  [[nodiscard]] Pose moved(const Pose& pose, double distance) const;
};

/// The motions of a pose's error, independent of each other, those that are known least first.
[[nodiscard]] std::vector<ScanMotion> motions_of_error(const PoseEstimate& world_from_sensor,
                                                       std::span<const SurfaceSample> samples);

/// Poses that a shape may not tell from this one: along the three motions that are known least, by several times
/// `resolution` metres and, about an axis, by up to half a turn; and turned about the main axes of the samples by what
/// symmetric shapes often have.
[[nodiscard]] std::vector<Pose> poses_along_valleys(const PoseEstimate& world_from_sensor,
                                                    std::span<const SurfaceSample> samples, double resolution);

}  // namespace vantage
