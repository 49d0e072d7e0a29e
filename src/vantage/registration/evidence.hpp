#pragma once

#include <optional>
#include <span>

#include "vantage/registration/model_surface.hpp"
#include "vantage/registration/oriented_index.hpp"
#include "vantage/registration/pose_fit.hpp"

namespace vantage {

/// What speaks for and against a pose, counted in samples of the scan and of the model.
struct PoseEvidence {
  double asked = 0;              // samples of the scan
  double near = 0;               // of them, those with a surfel of the model beside them
  double on_surface = 0;         // of those, the ones that lie on it, within three standard deviations
  double squared_distances = 0;  // of those to the model's planes, m^2
  double looked_at = 0;          // samples of scan and model of which a range image of the other says something
  double in_free_space = 0;      // of them, those in space that it shows to be empty
  double unseen = 0;             // samples of the scan where neither a surface nor free space is known
  /// Logarithm of the likelihood against one under which nothing is known of what the scan meets.
  double log_likelihood = 0;

  [[nodiscard]] double overlap() const { return asked > 0 ? on_surface / asked : 0; }
};

/// A sample of the scan at its place in the world, and the model's sample that it should lie on, if there is one.
struct PlacedSample {
  SurfaceSample sample;
  const SurfaceSample* partner = nullptr;
};

/// How partners are compared.
struct PartnerLimits {
  double reach = 0;  // farthest beside the partner that the same surface goes on, metres
  double floor = 0;  // variance that is added to those of both samples, m^2
  /// Where nothing moves (world frame), so that free space means something; everywhere if not given.
  std::optional<Box3> still = {};
  /// A surface in free space speaks against the pose only where the same surface is known nearer than this, metres:
  /// what is farther from all that is known was not there before, and says nothing of where the sensor was.
  double explained_within = 0;
  const OrientedIndex* known = nullptr;  // of the model; where it is not given everything counts
};

/// Weighs a pose against the model. `own`: what the scan itself shows to be empty, if that is known.
[[nodiscard]] PoseEvidence evidence_at(const Pose& world_from_sensor, std::span<const PlacedSample> samples,
                                       const FreeSpace* own, const RegisteredSurface& model,
                                       const PartnerLimits& limits);

}  // namespace vantage
