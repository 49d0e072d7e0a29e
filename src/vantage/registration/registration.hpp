#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vantage/registration/model_surface.hpp"
#include "vantage/registration/pose_estimate.hpp"

namespace vantage {

/// How scans are registered. What is not given follows from the sensor's noise and the distance between points.
struct RegistrationOptions {
  /// Poses drawn from the prior that the search begins at, where it is larger than the surface's details; even.
  int starts = 24;
  /// Share of what a sensor measures that may be wrong by more than its noise (mixed pixels, reflections, things that
  /// moved), and so appear in free space.
  double outlier_share = 0.01;
  /// Box in which nothing moves from scan to scan (frame of the model), so that free space in it means something;
  /// everywhere if not given.
  std::optional<Box3> still = {};
  /// How far surfaces may be put off by what remains unknown of the pose, metres (95 %); where not given three standard
  /// deviations of a depth, or half a surfel where that is more.
  std::optional<double> largest_misplacement;
  /// Largest probability that another pose is the right one.
  double ambiguity = 0.05;

  /// Throws InputError naming the field and its value.
  void validate() const;
};

enum class Verdict {
  registered,
  insufficient_overlap,  // too little of the scan lies on the model
  not_converged,         // the pose still moved after the last iteration
  beyond_prior,          // the pose is farther from the believed one than the robot errs, at 99.9 %
  large_residual,        // surfaces next to each other do not fit
  degenerate,            // the overlap leaves motions open in which the believed pose is not good enough
  in_free_space,         // surfaces would stand where a sensor has looked through
  ambiguous,             // a different pose is about as probable
};

[[nodiscard]] std::string_view name(Verdict verdict);

/// What registration found. Only a scan with the verdict `registered` may be merged.
struct Registration {
  Pose world_from_sensor = Pose::Identity();
  /// Of pose_step(world_from_sensor, the true pose): prior and surfaces together. Directions that the surfaces leave
  /// open keep what the prior says, mean and covariance.
  Mat6 covariance = Mat6::Zero();
  /// What the surfaces alone say of the step (inverse covariance); 0 in the directions that they leave open.
  Mat6 information = Mat6::Zero();
  Verdict verdict = Verdict::insufficient_overlap;
  double value = 0, limit = 0;      // the number that the verdict rests on, and what it may be; see `explanation`
  double overlap = 0;               // share of the scan's samples that lie on the model, 0..1
  double residual = 0;              // RMS distance of these to the model, metres
  double prior_chi_squared = 0;     // squared distance from the prior's mean in standard deviations
  double free_space_share = 0;      // of what range images say something of: surfaces that would be in free space
  double misplacement = 0;          // standard deviation along the normals that 95 % of the samples stay below, metres
  double rival_probability = 0;     // of the most probable other pose
  int undetermined_directions = 0;  // motions that the surfaces leave open
  std::string explanation;          // one sentence for people

  [[nodiscard]] bool succeeded() const { return verdict == Verdict::registered; }
  [[nodiscard]] PoseEstimate estimate() const { return {world_from_sensor, covariance}; }
};

/// The most probable pose of a scan (maximum a posteriori): the prior is what is believed of it, the likelihood how its
/// surfaces and its free space agree with the model's, in the sensor's noise. The result has the same bits for any
/// number of threads. Throws InputError for options and priors out of range; everything about the data is in the
/// verdict.
[[nodiscard]] Registration register_scan(const RegisteredSurface& model, const ScanSurface& scan,
                                         const PoseEstimate& world_from_sensor,
                                         const RegistrationOptions& options = {});

/// The same for two scans: `fixed_from_moving` is what is believed of where the sensor of the one was, seen from that
/// of the other; so is the result.
[[nodiscard]] Registration register_pair(const ScanSurface& fixed, const ScanSurface& moving,
                                         const PoseEstimate& fixed_from_moving,
                                         const RegistrationOptions& options = {});

}  // namespace vantage
