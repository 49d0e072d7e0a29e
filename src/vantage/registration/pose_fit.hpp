#pragma once

#include <span>

#include "vantage/registration/pose_estimate.hpp"
#include "vantage/registration/scan_surface.hpp"

namespace vantage {

/// A sample of a scan and the sample of the model that it should lie on, world frame.
struct SurfacePair {
  Vec3 point;   // of the scan
  Vec3 target;  // of the model
  Vec3 normal;  // half way between both normals: the chords of a curved surface are perpendicular to it
  Vec3 scan_normal, model_normal;
  double variance = 0;  // of the distance along the normal, m^2

  [[nodiscard]] double residual() const { return normal.dot(target - point); }
};

/// `scan` at its place in the world, and what it should lie on. `floor`: variance that is added to those of both, m^2.
[[nodiscard]] SurfacePair surface_pair(const SurfaceSample& scan, const SurfaceSample& model, double floor);

/// What pairs say of a step of the pose (see pose_step): point to plane, in units of information.
struct Information {
  Mat6 matrix = Mat6::Zero();
  Vec6 side = Vec6::Zero();
  /// As `matrix`, but from products of model and scan normals. Noise of the normals feigns information in `matrix`
  /// where there is none; it is independent in model and scan and averages out here.
  Mat6 agreed = Mat6::Zero();
  int pairs = 0;

  /// A pair is weighted down as its residual exceeds its standard deviation together with `spread`, which stands for
  /// how far off the pose still is, metres.
  void add(const SurfacePair& pair, const Vec3& sensor_position, double spread);
};

[[nodiscard]] Information information(std::span<const SurfacePair> pairs, const Vec3& sensor_position, double spread);

/// A prior in the coordinates u in which it is standard normal: step = root * u.
class WhitenedPrior {
 public:
  using Root = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  explicit WhitenedPrior(const PoseEstimate& prior) : mean_(prior.mean), root_(root_of_variances(prior.covariance)) {}

  [[nodiscard]] const Pose& mean() const { return mean_; }
  [[nodiscard]] const Root& root() const { return root_; }
  [[nodiscard]] Eigen::Index dimensions() const { return root_.cols(); }
  [[nodiscard]] Pose pose(const Eigen::VectorXd& u) const { return stepped(mean_, root_ * u); }

 private:
  Pose mean_;
  Root root_;
};

/// The directions of u that pairs determine, and those that they leave open: orthonormal columns.
struct PoseAxes {
  Eigen::MatrixXd determined, open;
  double shared_variance = 0;  // in u, of the errors that all pairs share
};

/// Open are the directions of which the pairs know less than the prior, or in which what they seem to know may come
/// from the noise of their normals. `shared_error`: part of a pair's standard deviation that all pairs have in common,
/// so that it does not average out.
[[nodiscard]] PoseAxes pose_axes(const WhitenedPrior& prior, const Information& pairs, double shared_error);

/// The step in u to the most probable pose, and how well it is known then.
struct PosteriorStep {
  Eigen::VectorXd step;
  Mat6 covariance = Mat6::Zero();   // of the pose's step, prior and pairs together
  Mat6 information = Mat6::Zero();  // by the pairs alone, 0 in the directions that they leave open
};

/// Gauss-Newton step to the maximum of the posterior, everything counted: for a search that is still far off.
[[nodiscard]] Eigen::VectorXd searching_step(const WhitenedPrior& prior, const Information& pairs,
                                             const Eigen::VectorXd& u);

/// The same, with the open directions kept where the prior has them.
[[nodiscard]] PosteriorStep posterior_step(const WhitenedPrior& prior, const Information& pairs,
                                           const Eigen::VectorXd& u, const PoseAxes& axes);

}  // namespace vantage
