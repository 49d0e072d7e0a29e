#pragma once

#include <vector>

#include "vantage/robot/pose_error.hpp"

namespace vantage {

struct ErrorLearnerOptions {
  Vec3 prior_deviation = Vec3::Constant(0.05);  // metres per axis, believed before the first scan
  double prior_orientation = radians(1);        // of pan, tilt and roll
  double prior_mean_weight = 1;                 // kappa_0: scans that the belief in a mean of zero is worth
  double prior_covariance_weight = 1;           // scans that the belief in the deviations is worth: nu_0 = this + 4
  double wild_deviations = 6;                   // differences farther from the median than this are left out

  /// Throws InputError naming the field.
  void validate() const;
};

/// Learns how the robot errs from the differences between commanded and registered poses (docs/positioning-error.md):
/// a normal-inverse-Wishart posterior for the position and one for the orientation, which are taken as independent.
/// Registrations that are wildly wrong are recognised by the median of all differences, axis by axis, and left out;
/// since all are looked at again each time, one that was let in early drops out when others contradict it.
class ErrorLearner {
 public:
  explicit ErrorLearner(const ErrorLearnerOptions& options = {});

  /// A scan whose registration succeeded.
  void add(const View& commanded, const View& registered);
  /// Posterior expectation of mean and covariance; the prior before the first scan.
  [[nodiscard]] PoseError estimate() const;
  /// What to expect of the next move: the estimate, widened by what is not known of its mean.
  [[nodiscard]] PoseError prediction() const;
  [[nodiscard]] int observations() const { return static_cast<int>(differences_.size()); }
  /// How many of them are left out as wildly wrong.
  [[nodiscard]] int left_out() const;

 private:
  [[nodiscard]] std::vector<PoseError::Vector> plausible() const;
  [[nodiscard]] PoseError::Vector prior_deviations() const;

  ErrorLearnerOptions options_;
  std::vector<PoseError::Vector> differences_;
};

}  // namespace vantage
