#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "vantage/registration/evidence.hpp"
#include "vantage/registration/oriented_index.hpp"
#include "vantage/registration/pose_fit.hpp"

namespace vantage {

/// A pose at which the posterior has a peak.
struct PoseMode {
  Eigen::VectorXd u;  // in the whitened prior
  Pose pose = Pose::Identity();
  PoseEvidence evidence;
  PosteriorStep posterior;   // at the peak
  PoseAxes axes;             // the directions that pairs determine, and those that they leave open
  double log_posterior = 0;  // at the peak
  double log_mass = 0;       // of the whole peak
  bool converged = false;
};

/// How far apart surfaces are compared at first, metres: what the coarse search of a scan against this model resolves.
[[nodiscard]] double coarse_spread(const RegisteredSurface& model, const ScanSurface& scan);

/// The peaks of a pose's posterior: point to plane from deterministic samples of the prior, coarse to fine. The kernel
/// of the residuals begins with how far the prior lets points be off and ends with the sensor's noise, so that what is
/// still misplaced has its say at first. The same bits for any number of threads.
class PoseSearch {
 public:
  /// All three must outlive the search. `starts`: samples of the prior where it is larger than the surface's details.
  /// `still`: see RegistrationOptions.
  PoseSearch(const RegisteredSurface& model, const ScanSurface& scan, const PoseEstimate& prior, int starts,
             const std::optional<Box3>& still = {});

  /// Best first; at least one.
  [[nodiscard]] std::vector<PoseMode> modes() const;
  /// The peak that the coarse search reaches from the prior's mean: its log_posterior tells it from those of other
  /// priors.
  [[nodiscard]] PoseMode coarse_peak() const;
  /// A coarse peak refined and weighed.
  [[nodiscard]] PoseMode fine_peak(PoseMode coarse) const;

  [[nodiscard]] const WhitenedPrior& prior() const { return prior_; }
  /// RMS distance of the scan's samples between two poses, metres.
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const;
  /// How far surfaces lie off along their normals with this covariance of the pose, those of the scan and those of the
  /// model that it looks at, whichever way they face: the standard deviation that 95 % of them stay below, metres.
  [[nodiscard]] double misplacement(const Pose& pose, const Mat6& covariance) const;
  /// Typical standard deviation of the distance between samples that belong together, metres.
  [[nodiscard]] double typical_deviation() const;
  /// Side of the model's surfels, metres.
  [[nodiscard]] double cell() const { return model_.surfels().cell(); }

 private:
  [[nodiscard]] Eigen::MatrixXd starts() const;
  [[nodiscard]] PoseMode coarse_mode(const Eigen::VectorXd& start) const;
  [[nodiscard]] std::vector<PoseMode> coarse_modes() const;
  void narrow(PoseMode& mode) const;
  void refine(PoseMode& mode) const;
  [[nodiscard]] PoseEvidence evidence(std::span<const SurfaceSample> samples, const Pose& pose) const;
  void weigh(PoseMode& mode) const;
  [[nodiscard]] Information coarse_pairs(std::span<const SurfaceSample> samples, const Pose& pose, double spread) const;
  [[nodiscard]] Information fine_pairs(const Pose& pose, double spread) const;
  [[nodiscard]] double moved(const Eigen::VectorXd& step) const;
  /// How far errors of the pose with this covariance put the samples off (RMS), metres.
  [[nodiscard]] double moved_by(const Mat6& covariance) const;

  const RegisteredSurface& model_;
  const ScanSurface& scan_;
  WhitenedPrior prior_;
  int starts_;
  std::optional<Box3> still_;
  /// Of the scan: with all directions of normals as far as there are any, and as the scan has them.
  std::vector<SurfaceSample> coarse_, medium_, fine_, even_;
  std::unique_ptr<const OrientedIndex> index_;  // of the model's surfels
  double reach_ = 0;          // RMS distance of the samples from where the prior's mean puts them, metres
  double coarse_spread_ = 0;  // with which the coarse search ends, metres
  double floor_ = 0;          // variance of what noise does not explain, m^2
};

}  // namespace vantage
