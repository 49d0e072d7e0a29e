#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/robot/error_learner.hpp"
#include "vantage/robot/error_model.hpp"

namespace vantage {

/// How the robot errs, what the planner believes of that, and how it plans with it (docs/positioning-error.md). Texts
/// and units are those of the command line: metres, degrees.
struct ErrorOptions {
  using Vec6 = Eigen::Matrix<double, 6, 1>;

  Vec3 positioning_error = Vec3::Zero();
  Vec3 orientation_error = Vec3::Zero();
  Vec6 error_mean = Vec6::Zero();
  std::optional<Vec6> error_covariance;
  Vec6 error_growth = Vec6::Zero();
  std::optional<Vec3> turntable_error;

  std::optional<std::string> believed_error;
  std::optional<Vec3> believed_orientation_error;
  std::optional<Vec6> believed_mean;
  std::optional<Vec6> believed_covariance;
  std::optional<Vec6> believed_growth;

  std::string convolve = "off";
  int error_candidates = 12;
  int error_samples = 32;
  double least_overlap = 0.1;
  double registrable = 0.5;

  /// Throws InputError naming the option. `center`: of the scene, around which a turntable turns.
  void validate_errors(const Vec3& center) const;
  /// How the simulated robot errs; none where it is exact.
  [[nodiscard]] std::shared_ptr<const PoseErrorModel> robot_error(const Vec3& center) const;
  /// How the planner believes that it errs: where nothing else is said, as it does. Where the error is learned, the
  /// prior.
  [[nodiscard]] std::shared_ptr<const PoseErrorModel> believed_error_model(const Vec3& center) const;
  /// Where the error is learned, what is believed of it at first.
  [[nodiscard]] std::optional<ErrorLearnerOptions> learner_options() const;
  [[nodiscard]] bool learns_error() const { return learner_options().has_value(); }
};

/// The options that say what is believed and how that is planned with; the others are the simulated robot's.
[[nodiscard]] std::vector<std::string> believed_error_option_names();

template <class Field>
void describe(ErrorOptions& o, Field&& field) {
  field("positioning-error", o.positioning_error, "m", "standard deviation of the robot's position per axis");
  field("orientation-error", o.orientation_error, "degrees", "standard deviation of the robot's pan, tilt and roll");
  field("error-mean", o.error_mean, "m, degrees", "mean of the robot's error: x,y,z,pan,tilt,roll");
  field("error-covariance", o.error_covariance, "m^2",
        "of the robot's position: xx,xy,xz,yy,yz,zz; instead of positioning-error");
  field("error-growth", o.error_growth, "m/m, degrees/m",
        "what the deviations x,y,z,pan,tilt,roll of the robot grow by with every metre of a move");
  field("turntable-error", o.turntable_error, "degrees, m",
        "deviations of azimuth, elevation and reach of an arm around a turntable; instead of the errors above");
  field("believed-error", o.believed_error, "m",
        "standard deviation per axis that the planner assumes; or learn, or learn:SX,SY,SZ with what to assume at "
        "first; that of the robot if not given");
  field("believed-orientation-error", o.believed_orientation_error, "degrees",
        "standard deviation of pan, tilt and roll that the planner assumes; that of the robot if not given");
  field("believed-mean", o.believed_mean, "m, degrees", "mean error that the planner assumes: x,y,z,pan,tilt,roll");
  field("believed-covariance", o.believed_covariance, "m^2",
        "of the position, as the planner assumes: xx,xy,xz,yy,yz,zz; instead of believed-error");
  field("believed-growth", o.believed_growth, "m/m, degrees/m", "growth of the error that the planner assumes");
  field(
      "convolve", o.convolve, "",
      "planning with the believed error: off, on (convolution after evaluation), normalised, or samples (what is seen "
      "from sampled poses, position and orientation)");
  field("error-candidates", o.error_candidates, "", "strongest views that poses are sampled around");
  field("error-samples", o.error_samples, "", "poses around each of them, an even number");
  field("least-overlap", o.least_overlap, "",
        "share of known surface in a view from which its scan counts as one that can be registered");
  field("registrable", o.registrable, "",
        "where scans are registered: probability, planned from the overlap's information, that a view's scan ends up "
        "less than half a voxel off; views below come last; 0: do not plan for it");
}

}  // namespace vantage
