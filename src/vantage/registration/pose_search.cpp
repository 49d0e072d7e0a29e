#include "vantage/registration/pose_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vantage/core/normal_points.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/registration/sample_choice.hpp"

namespace vantage {
namespace {

constexpr std::size_t coarse_samples = 300, medium_samples = 1000, fine_samples = 3000;
constexpr std::size_t coarse_surfels = 3000;
constexpr std::size_t most_modes = 4;

SurfaceSample placed(const SurfaceSample& sample, const Pose& pose) {
  return {pose * sample.point, pose.linear() * sample.normal, sample.sigma};
}

/// Part of the errors that is common to all samples of a scan and does not average out (the model's own pose, the
/// sensor's distortion, the bending of cells), as for the pixels of a neighbourhood.
constexpr double shared_error = 0.3;

/// Part of a sample in what speaks for a pose against another: the scan's own errors are in both.
double worth_of_sample(double samples) {
  constexpr double shared_variance = 0.01;
  return 1 / (1 + shared_variance * samples);
}

}  // namespace

double coarse_spread(const RegisteredSurface& model, const ScanSurface& scan) {
  const std::size_t stride = (model.surfels().surfels().size() + coarse_surfels - 1) / coarse_surfels;
  const double apart = model.surfels().cell() * std::sqrt(static_cast<double>(stride));
  return std::max(0.5 * apart, 3 * std::max(model.sigma(), scan.sigma));
}

PoseSearch::PoseSearch(const RegisteredSurface& model, const ScanSurface& scan, const PoseEstimate& prior, int starts,
                       const std::optional<Box3>& still)
    : model_(model),
      scan_(scan),
      prior_(prior),
      starts_(starts),
      still_(still),
      coarse_(picked_by_normal(scan.samples, coarse_samples)),
      medium_(picked_by_normal(scan.samples, medium_samples)),
      fine_(picked_by_normal(scan.samples, fine_samples)),
      even_(picked_evenly(scan.samples, fine_samples)) {
  reach_ = moved_by(prior_.root() * prior_.root().transpose());
  const double sigma = std::max(model.sigma(), scan.sigma);
  coarse_spread_ = coarse_spread(model, scan);
  // Noise that a neighbourhood shares, and surfaces that bend within a cell.
  const double shared = 0.3 * sigma, bending = 0.03 * cell();
  floor_ = shared * shared + bending * bending;
  index_ = std::make_unique<const OrientedIndex>(model.surfels().surfels(), coarse_surfels,
                                                 std::max(reach_, coarse_spread_));
}

double PoseSearch::distance(const Pose& a, const Pose& b) const {
  return distance_between(coarse_, a, b, coarse_.size() + 1);
}

double PoseSearch::moved(const Eigen::VectorXd& step) const {
  const Vec6 motion = prior_.root() * step;
  double squares = 0;
  for (const SurfaceSample& sample : coarse_) {
    const Vec3 arm = prior_.mean().linear() * sample.point;
    squares += (motion.head<3>() + motion.tail<3>().cross(arm)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, coarse_.size())));
}

double PoseSearch::moved_by(const Mat6& covariance) const {
  double squares = 0;
  for (const SurfaceSample& sample : coarse_) {
    const Eigen::Matrix<double, 3, 6> effect = effect_at(prior_.mean().linear() * sample.point).topRows<3>();
    squares += (effect * covariance * effect.transpose()).trace();
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, coarse_.size())));
}

double PoseSearch::misplacement(const Pose& pose, const Mat6& covariance) const {
  std::vector<SurfaceSample> surfaces;
  surfaces.reserve(fine_.size());
  for (const SurfaceSample& sample : fine_) surfaces.push_back(placed(sample, pose));
  if (scan_.free_space) {
    const Pose sensor_from_world = pose.inverse();
    for (const SurfaceSample& surfel : model_.surfels().surfels()) {
      const bool is_looked_at = scan_.free_space->at(sensor_from_world * surfel.point) != FreeSpace::Answer::unknown;
      if (is_looked_at && (!still_ || still_->contains(surfel.point))) surfaces.push_back(surfel);
    }
  }
  std::vector<double> variances;
  variances.reserve(fine_samples);
  for (const SurfaceSample& sample : picked_by_normal(surfaces, fine_samples)) {
    Vec6 effect;
    effect << sample.normal, (sample.point - pose.translation()).cross(sample.normal);
    variances.push_back(effect.dot(covariance * effect));
  }
  if (variances.empty()) return 0;
  return std::sqrt(std::max(0.0, lower_quantile(std::move(variances), 0.95)));
}

double PoseSearch::typical_deviation() const {
  double sum = 0;
  for (const SurfaceSample& sample : coarse_) sum += std::sqrt(2 * sample.sigma * sample.sigma + floor_);
  return sum / static_cast<double>(std::max<std::size_t>(1, coarse_.size()));
}

Eigen::MatrixXd PoseSearch::starts() const {
  const auto d = prior_.dimensions();
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(d, 1);
  if (d == 0 || reach_ <= coarse_spread_) return points;
  const Eigen::MatrixXd others = normal_points(static_cast<int>(d), starts_);
  points.conservativeResize(d, 1 + others.cols());
  points.rightCols(others.cols()) = others;
  return points;
}

Information PoseSearch::coarse_pairs(std::span<const SurfaceSample> samples, const Pose& pose, double spread) const {
  Information sum;
  for (const SurfaceSample& in_sensor : samples) {
    const SurfaceSample sample = placed(in_sensor, pose);
    const SurfaceSample* found = index_->nearest(sample);
    if (found == nullptr || (found->point - sample.point).squaredNorm() > 9 * spread * spread) continue;
    sum.add(surface_pair(sample, *found, floor_), pose.translation(), spread);
  }
  return sum;
}

PoseMode PoseSearch::coarse_mode(const Eigen::VectorXd& start) const {
  PoseMode mode;
  mode.u = start;
  double spread = std::max(reach_, coarse_spread_);
  constexpr int iterations = 24;
  for (int i = 0; i < iterations; ++i) {
    const Pose pose = prior_.pose(mode.u);
    const Eigen::VectorXd step = searching_step(prior_, coarse_pairs(coarse_, pose, spread), mode.u);
    mode.u += step;
    if (spread <= coarse_spread_ && moved(step) < 0.1 * coarse_spread_) break;
    if (i % 2 == 1) spread = std::max(coarse_spread_, 0.6 * spread);
  }
  mode.pose = prior_.pose(mode.u);
  std::vector<PlacedSample> samples;
  samples.reserve(coarse_.size());
  for (const SurfaceSample& in_sensor : coarse_) {
    const SurfaceSample sample = placed(in_sensor, mode.pose);
    samples.push_back({sample, index_->nearest(sample)});
  }
  const PartnerLimits limits{.reach = 2 * coarse_spread_,
                             .floor = floor_ + coarse_spread_ * coarse_spread_ / 4,
                             .still = still_,
                             .explained_within = 2 * coarse_spread_ + 2 * reach_,
                             .known = index_.get()};
  mode.evidence = evidence_at(mode.pose, samples, scan_.free_space ? &*scan_.free_space : nullptr, model_, limits);
  mode.log_posterior = mode.evidence.log_likelihood - 0.5 * mode.u.squaredNorm();
  return mode;
}

std::vector<PoseMode> PoseSearch::coarse_modes() const {
  const Eigen::MatrixXd points = starts();
  std::vector<PoseMode> all(static_cast<std::size_t>(points.cols()));
  parallel_for(all.size(), [&](std::size_t i) { all[i] = coarse_mode(points.col(static_cast<Eigen::Index>(i))); });
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.log_posterior > b.log_posterior; });
  std::vector<PoseMode> kept;
  for (PoseMode& mode : all) {
    const auto is_twin = [&](const PoseMode& other) { return distance(other.pose, mode.pose) < 2 * coarse_spread_; };
    if (std::any_of(kept.begin(), kept.end(), is_twin)) continue;
    kept.push_back(std::move(mode));
    if (kept.size() == most_modes) break;
  }
  parallel_for(kept.size(), [&](std::size_t i) { narrow(kept[i]); });
  return kept;
}

void PoseSearch::narrow(PoseMode& mode) const {
  double spread = coarse_spread_;
  for (int i = 0; i < 6; ++i) {
    mode.u += searching_step(prior_, coarse_pairs(medium_, prior_.pose(mode.u), spread), mode.u);
    if (i % 2 == 1) spread *= 0.5;
  }
}

Information PoseSearch::fine_pairs(const Pose& pose, double spread) const {
  Information sum;
  const SurfelMap& surfels = model_.surfels();
  for (const SurfaceSample& in_sensor : fine_) {
    const SurfaceSample sample = placed(in_sensor, pose);
    const int found = surfels.nearest(sample.point, sample.normal);
    if (found < 0) continue;
    const SurfacePair pair = surface_pair(sample, surfels.surfels()[static_cast<std::size_t>(found)], floor_);
    // Past the model's border nothing is known of the surface; pairs across the border would pull the scan sideways.
    const Vec3 offset = pair.target - pair.point;
    if ((offset - pair.normal * pair.residual()).squaredNorm() > cell() * cell()) continue;
    sum.add(pair, pose.translation(), spread);
  }
  return sum;
}

void PoseSearch::refine(PoseMode& mode) const {
  constexpr int iterations = 30, settling = 6;
  double spread = cell();
  for (int i = 0; i < iterations; ++i) {
    const Information pairs = fine_pairs(prior_.pose(mode.u), spread);
    // After some steps no direction changes sides, so that the pose cannot swing for ever.
    if (i < settling) mode.axes = pose_axes(prior_, pairs, shared_error);
    mode.posterior = posterior_step(prior_, pairs, mode.u, mode.axes);
    // Noise makes samples switch between neighbouring surfels for ever: half steps settle between them, and steps far
    // below a cell are no more than that.
    mode.u += (i < 2 * iterations / 3 ? 1.0 : 0.5) * mode.posterior.step;
    const double distance = moved(mode.posterior.step);
    mode.converged = spread == 0 && distance < 0.1 * cell();
    if (spread == 0 && distance < 1e-3 * cell()) break;
    if (i % 2 == 1) spread = spread > 0.05 * cell() ? spread / 3 : 0;
  }
  mode.pose = prior_.pose(mode.u);
}

PoseEvidence PoseSearch::evidence(std::span<const SurfaceSample> of, const Pose& pose) const {
  std::vector<PlacedSample> samples;
  samples.reserve(of.size());
  for (const SurfaceSample& in_sensor : of) {
    const SurfaceSample sample = placed(in_sensor, pose);
    const int found = model_.surfels().nearest(sample.point, sample.normal);
    samples.push_back({sample, found < 0 ? nullptr : &model_.surfels().surfels()[static_cast<std::size_t>(found)]});
  }
  return evidence_at(pose, samples, scan_.free_space ? &*scan_.free_space : nullptr, model_,
                     {.reach = cell(),
                      .floor = floor_,
                      .still = still_,
                      .explained_within = cell() + 2 * reach_,
                      .known = index_.get()});
}

void PoseSearch::weigh(PoseMode& mode) const {
  mode.evidence = evidence(even_, mode.pose);
  const double worth = worth_of_sample(mode.evidence.near);
  mode.log_posterior = worth * mode.evidence.log_likelihood - 0.5 * mode.u.squaredNorm();
  // Laplace: the height of the peak times its width, against that of the prior.
  const Mat6 ratio = Mat6::Identity() + mode.posterior.information * prior_.root() * prior_.root().transpose();
  mode.log_mass = mode.log_posterior - 0.5 * std::log(std::max(1.0, ratio.determinant()));
}

PoseMode PoseSearch::coarse_peak() const { return coarse_mode(Eigen::VectorXd::Zero(prior_.dimensions())); }

PoseMode PoseSearch::fine_peak(PoseMode coarse) const {
  narrow(coarse);
  refine(coarse);
  weigh(coarse);
  return coarse;
}

std::vector<PoseMode> PoseSearch::modes() const {
  std::vector<PoseMode> found = coarse_modes();
  parallel_for(found.size(), [&](std::size_t i) {
    refine(found[i]);
    weigh(found[i]);
  });
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.log_mass > b.log_mass; });
  return found;
}

}  // namespace vantage
