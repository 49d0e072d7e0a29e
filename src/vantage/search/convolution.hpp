#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vantage/candidates/candidates.hpp"
#include "vantage/robot/positioning_error.hpp"

namespace vantage {

struct ConvolutionOptions {
  bool normalise = false;                 // divide by the sum of the kernel; the paper keeps A = 1
  std::optional<double> truncate_sigmas;  // leave out errors farther than this from the mean, per axis; not by default

  void validate() const;
};

/// Convolution after evaluation (paper, section 7; spec, section 6): the utility that is expected of each candidate
/// when the robot errs. `utilities[i]` belongs to candidate i and is 0 where the candidate is infeasible. On a view
/// cube: eq. 20, sum over m of f[m] g[v + m] with f of eq. 19 and A = 1; separable where the axes err independently. On
/// other candidate sets: the mean over the neighbours within four standard deviations, weighted by f.
[[nodiscard]] std::vector<double> convolve(std::span<const double> utilities, const Candidates& candidates,
                                           const PositioningError& error, const ConvolutionOptions& options = {});

/// The same for a robot whose error depends on the candidate, one error each. Always normalised by the whole kernel:
/// with A = 1 a candidate would be worth the more the worse the robot gets there.
[[nodiscard]] std::vector<double> convolve_each(std::span<const double> utilities, const Candidates& candidates,
                                                std::span<const PositioningError> error_of_candidate,
                                                const ConvolutionOptions& options = {});

/// Eq. 19 with A = 1 for one error; along directions in which the covariance is zero it is 1 within `resolution` of the
/// mean and 0 elsewhere.
class ErrorDensity {
 public:
  /// `resolution`: metres per axis below which positions count as the same.
  ErrorDensity(const PositioningError& error, const Vec3& resolution);
  [[nodiscard]] double operator()(const Vec3& offset) const;
  /// Squared Mahalanobis distance of an error from the mean; infinite where the covariance forbids it.
  [[nodiscard]] double squared_distance(const Vec3& offset) const;

 private:
  Vec3 mean_;
  Mat3 axes_;              // eigenvectors of the covariance
  Vec3 inverse_variance_;  // 0 along forbidden directions
  Vec3 tolerance_;         // along forbidden directions, metres
};

}  // namespace vantage
