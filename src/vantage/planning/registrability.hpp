#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vantage/robot/error_model.hpp"
#include "vantage/search/search.hpp"
#include "vantage/sensor/sensor_model.hpp"

// Whether the scan of a view could be registered: constraint 4 of the paper, after Low and Lastra.
namespace vantage {

struct RegistrabilityOptions {
  /// How the robot errs, as far as the planner knows; none: poses are known and nothing has to be registered.
  std::shared_ptr<const PoseErrorModel> error = {};
  SensorModel sensor = {};
  /// A view is admissible where the surface ends up less than half a voxel off with this probability ...
  double least_probability = 0.5;
  /// ... and where known surface is this share of what it sees.
  double least_overlap = 0.1;
  /// Views that are not admissible are taken where no admissible one is left, unless their probability is below this.
  double fair_chance = 0.05;

  /// Throws InputError naming the option.
  void validate() const;
};

/// The occupied voxels of a map that have a normal: what scans are registered against, and what must not be misplaced.
class KnownSurface {
 public:
  KnownSurface(const VoxelMap& map, const SensorModel& sensor);

  /// Of a scan from `view` that sees these voxels (those without a normal say nothing), if the robot ends up there with
  /// this error. One vote per voxel: what the points in it have in common does not average out.
  [[nodiscard]] Registrability registrability(const View& view, std::span<const Index3> seen,
                                              const PoseError& error) const;

 private:
  struct Patch {
    Vec3 point, normal;  // world
  };
  [[nodiscard]] PoseError::Matrix mean_effect(const View& view) const;

  const VoxelMap& map_;
  SensorModel sensor_;
  std::vector<Patch> patches_;
};

/// Chance that registration accepts the scan of a view with so many points on known voxels, if its pose comes out
/// right: directions that few noisy normals speak of count as open, and verdicts are careful. Fitted to scans of
/// `experiment robustness` that were planned without it, by the count that the utility `gain` has; visible_voxels()
/// counts fewer, so that plans are more careful than that. Never less than 0.06, since few of those scans showed less
/// than 3,000 points.
[[nodiscard]] double chance_of_acceptance(double known_points);

/// By how much an error of a view's pose (in the order of PoseError) moves a measured point along a normal, per unit.
[[nodiscard]] PoseError::Vector effect_of_error(const View& view, const Vec3& point, const Vec3& normal);

/// The covariance that is left of a prior one when measurements with this information come in. The prior may be
/// singular: what is certain stays certain.
[[nodiscard]] PoseError::Matrix posterior_covariance(const PoseError::Matrix& prior,
                                                     const PoseError::Matrix& information);

/// Probability that e^T `weights` e < `limit` for e ~ N(0, `covariance`): a gamma distribution with the same mean and
/// variance, by the cube-root normal approximation of Wilson and Hilferty.
[[nodiscard]] double probability_below(const PoseError::Matrix& weights, const PoseError::Matrix& covariance,
                                       double limit);

/// Views by what they promise times the probability that it can be had.
struct RegistrableViews {
  std::vector<Evaluation> ranking;  // those asked about: admissible ones first; empty where none has a fair chance
  double best_probability = 0;      // of those that meet more than the occplane voxels asked for
};

/// Ranks views (best first, as they come) by score times probability. The strongest are asked about, until none that
/// follows could come before an admissible one that meets more than `stop_occplane` occplane voxels.
[[nodiscard]] RegistrableViews rank_by_registrability(const ViewEvaluation& problem, std::vector<Evaluation> ranked,
                                                      const RegistrabilityOptions& options, int stop_occplane);

}  // namespace vantage
