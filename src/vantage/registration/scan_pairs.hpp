#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vantage/registration/pose_graph.hpp"
#include "vantage/registration/scan_surface.hpp"
#include "vantage/registration/surfel_map.hpp"

namespace vantage {

struct ScanPairOptions {
  std::size_t max_samples = 800;  // of a scan that are laid on the other one
  double least_overlap = 0.1;     // share of them that must lie on it
  int iterations = 12;
  /// Part of a sample's error that all samples of a scan have in common: however many there are, they are worth no more
  /// than one over its square.
  double shared_error = 0.3;

  void validate() const;
};

/// A scan in its own frame, ready to be laid on others and others on it. Its size is bounded.
class PairedSurface {
 public:
  explicit PairedSurface(const ScanSurface& scan, const ScanPairOptions& options = {});

  /// Share of its samples that lie on another scan.
  [[nodiscard]] double overlap(const PairedSurface& other, const Pose& other_from_this) const;
  /// How far the samples move in the mean between two poses, metres.
  [[nodiscard]] double mean_displacement(const Pose& a, const Pose& b) const;

 private:
  friend std::optional<PoseConstraint> constraint_between(const PairedSurface& from, const PairedSurface& to,
                                                          const Pose& from_of_to, const ScanPairOptions& options);
  SurfelMap surfels_;
  std::vector<SurfaceSample> samples_;
  double distance_ = 1;  // of the samples from the sensor, root of the mean square, metres
};

/// Lays `to` on `from`, from a pose that is off by no more than the samples are apart: point to plane in the sensor's
/// units. Its members `from` and `to` are left to the caller. Nothing where too little of them overlaps.
[[nodiscard]] std::optional<PoseConstraint> constraint_between(const PairedSurface& from, const PairedSurface& to,
                                                               const Pose& from_of_to,
                                                               const ScanPairOptions& options = {});

}  // namespace vantage
