#include "vantage/registration/scan_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/registration/pose_fit.hpp"
#include "vantage/registration/sample_choice.hpp"

namespace vantage {
namespace {

constexpr int fewest_pairs = 20;
constexpr std::size_t most_surfels = 4000;
constexpr std::size_t asked_samples = 200;  // about how much two scans overlap

Information pairs_at(const SurfelMap& surfels, const std::vector<SurfaceSample>& samples, const Pose& pose,
                     double spread) {
  Information sum;
  const double cell = surfels.cell();
  const double rounding = 0.01 * cell;  // surfaces that bend within a cell
  for (const SurfaceSample& sample : samples) {
    const SurfaceSample placed{pose * sample.point, pose.linear() * sample.normal, sample.sigma};
    const int found = surfels.nearest(placed.point, placed.normal);
    if (found < 0) continue;
    const SurfaceSample& surfel = surfels.surfels()[static_cast<std::size_t>(found)];
    // Past its border the other scan says nothing of the surface.
    const Vec3 offset = placed.point - surfel.point;
    if ((offset - surfel.normal * surfel.normal.dot(offset)).norm() > cell) continue;
    sum.add(surface_pair(placed, surfel, rounding * rounding), pose.translation(), spread);
  }
  return sum;
}

}  // namespace

void ScanPairOptions::validate() const {
  require(max_samples >= std::size_t{fewest_pairs}, "pairs of scans: max_samples = ", max_samples,
          ": must be at least ", fewest_pairs);
  require(least_overlap >= 0 && least_overlap <= 1, "pairs of scans: least_overlap = ", least_overlap,
          ": must be a share in [0, 1]");
  require(iterations >= 1, "pairs of scans: iterations = ", iterations, ": must be at least 1");
  require(shared_error > 0 && shared_error <= 1, "pairs of scans: shared_error = ", shared_error,
          ": must be in (0, 1]");
}

PairedSurface::PairedSurface(const ScanSurface& scan, const ScanPairOptions& options)
    : surfels_(scan.spacing > 0 ? scan.spacing : 1), samples_(picked_by_normal(scan.samples, options.max_samples)) {
  options.validate();
  for (const SurfaceSample& sample : picked_by_normal(scan.samples, most_surfels)) surfels_.add(sample);
  double squares = 0;
  for (const SurfaceSample& sample : samples_) squares += sample.point.squaredNorm();
  if (!samples_.empty()) distance_ = std::sqrt(squares / static_cast<double>(samples_.size()));
}

double PairedSurface::overlap(const PairedSurface& other, const Pose& other_from_this) const {
  const std::size_t stride = samples_.size() / asked_samples + 1;
  int asked = 0, on = 0;
  for (std::size_t i = 0; i < samples_.size(); i += stride, ++asked) {
    const SurfaceSample& sample = samples_[i];
    if (other.surfels_.nearest(other_from_this * sample.point, other_from_this.linear() * sample.normal) >= 0) ++on;
  }
  return asked == 0 ? 0 : static_cast<double>(on) / asked;
}

double PairedSurface::mean_displacement(const Pose& a, const Pose& b) const {
  double sum = 0;
  for (const SurfaceSample& sample : samples_) sum += (a * sample.point - b * sample.point).norm();
  return samples_.empty() ? 0 : sum / static_cast<double>(samples_.size());
}

std::optional<PoseConstraint> constraint_between(const PairedSurface& from, const PairedSurface& to,
                                                 const Pose& from_of_to, const ScanPairOptions& options) {
  options.validate();
  const double cell = from.surfels_.cell();
  const auto fewest = std::max(
      fewest_pairs, static_cast<int>(std::ceil(options.least_overlap * static_cast<double>(to.samples_.size()))));
  // What is not determined stays where it was: as if the pose were known to three cells, which the pairs outweigh.
  const WhitenedPrior prior(PoseEstimate::around(from_of_to, 3 * cell, 3 * cell / to.distance_));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(prior.dimensions());
  PosteriorStep posterior;
  double spread = 2 * cell;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const Information pairs = pairs_at(from.surfels_, to.samples_, prior.pose(u), spread);
    if (pairs.pairs < fewest) return std::nullopt;
    const PoseAxes axes = pose_axes(prior, pairs, options.shared_error);
    posterior = posterior_step(prior, pairs, u, axes);
    u += posterior.step;
    if (spread == 0 && posterior.step.norm() < 1e-3) break;
    spread = spread > 0.02 * cell ? spread / 3 : 0;
  }
  PoseConstraint constraint;
  constraint.from_of_to = prior.pose(u);
  constraint.information = posterior.information;
  return constraint;
}

}  // namespace vantage
