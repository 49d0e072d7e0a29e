#include "vantage/registration/pose_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "vantage/core/normal_points.hpp"
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

/// How a step of the sensor at the origin moves a point.
Eigen::Matrix<double, 3, 6> effect_of_step(const Vec3& arm) {
  Eigen::Matrix<double, 3, 6> effect;
  effect.leftCols<3>().setIdentity();
  effect.rightCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  return effect;
}

/// Part of a pair in what is known of the pose. Errors that neighbours share (the model's own pose, the sensor's
/// distortion, the bending of cells) are about a tenth of the noise and do not average out.
double worth_of_pair(int pairs) {
  constexpr double shared_variance = 0.01;
  return 1 / (1 + shared_variance * pairs);
}

struct SampleWeights {
  std::vector<double> values;  // their sum is 1
  double power = 1;            // of the probabilities: below 1 where they had to be flattened
};

/// Weights of samples whose probabilities have these logarithms, flattened until as many as `least` count.
SampleWeights sample_weights(const std::vector<double>& logs, double least) {
  const double highest = *std::max_element(logs.begin(), logs.end());
  SampleWeights weights{std::vector<double>(logs.size()), 1};
  constexpr double flattest = 1e-6;
  for (; weights.power > flattest; weights.power /= 2) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < logs.size(); ++i) {
      weights.values[i] = std::exp(weights.power * (logs[i] - highest));
      sum += weights.values[i];
      squares += weights.values[i] * weights.values[i];
    }
    for (double& value : weights.values) value /= sum;
    if (sum * sum / squares >= least) break;
  }
  return weights;
}

}  // namespace

int PoseMode::still_open() const {
  if (open.covariance.size() == 0) return 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(open.covariance, Eigen::EigenvaluesOnly);
  return static_cast<int>((solver.eigenvalues().array() > 0.5).count());
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
      fine_(picked_evenly(scan.samples, fine_samples)),
      few_(picked_evenly(scan.samples, medium_samples)) {
  double squares = 0;
  for (const SurfaceSample& sample : coarse_) {
    squares += (effect_of_step(prior_.mean().linear() * sample.point) * prior_.root()).squaredNorm();
  }
  reach_ = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, coarse_.size())));
  const double sigma = std::max(model.sigma(), scan.sigma);
  const std::size_t stride = (model.surfels().surfels().size() + coarse_surfels - 1) / coarse_surfels;
  coarse_spread_ = std::max(0.5 * cell() * std::sqrt(static_cast<double>(stride)), 3 * sigma);
  // Noise that a neighbourhood shares, and surfaces that bend within a cell.
  const double shared = 0.3 * sigma, bending = 0.01 * cell();
  floor_ = shared * shared + bending * bending;
}

double PoseSearch::distance(const Pose& a, const Pose& b) const {
  double squares = 0;
  for (const SurfaceSample& sample : coarse_) squares += (a * sample.point - b * sample.point).squaredNorm();
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, coarse_.size())));
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

double PoseSearch::misplacement(const Pose& pose, const Mat6& covariance) const {
  std::vector<double> variances;
  variances.reserve(fine_.size());
  for (const SurfaceSample& sample : fine_) {
    const Vec3 normal = pose.linear() * sample.normal, arm = pose.linear() * sample.point;
    Vec6 effect;
    effect << normal, arm.cross(normal);
    variances.push_back(effect.dot(covariance * effect));
  }
  if (variances.empty()) return 0;
  const auto high = variances.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(variances.size() - 1));
  std::nth_element(variances.begin(), high, variances.end());
  return std::sqrt(std::max(0.0, *high));
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

Information PoseSearch::coarse_pairs(const OrientedIndex& index, std::span<const SurfaceSample> samples,
                                     const Pose& pose, double spread) const {
  Information sum;
  for (const SurfaceSample& in_sensor : samples) {
    const SurfaceSample sample = placed(in_sensor, pose);
    const SurfaceSample* found = index.nearest(sample);
    if (found == nullptr || (found->point - sample.point).squaredNorm() > 9 * spread * spread) continue;
    sum.add(surface_pair(sample, *found, floor_), pose.translation(), spread);
  }
  return sum;
}

PoseMode PoseSearch::coarse_mode(const OrientedIndex& index, const Eigen::VectorXd& start) const {
  PoseMode mode;
  mode.u = start;
  double spread = std::max(reach_, coarse_spread_);
  constexpr int iterations = 24;
  for (int i = 0; i < iterations; ++i) {
    const Pose pose = prior_.pose(mode.u);
    const Eigen::VectorXd step = searching_step(prior_, coarse_pairs(index, coarse_, pose, spread), mode.u);
    mode.u += step;
    if (spread <= coarse_spread_ && moved(step) < 0.1 * coarse_spread_) break;
    if (i % 2 == 1) spread = std::max(coarse_spread_, 0.6 * spread);
  }
  mode.pose = prior_.pose(mode.u);
  std::vector<PlacedSample> samples;
  for (const SurfaceSample& in_sensor : coarse_) {
    const SurfaceSample sample = placed(in_sensor, mode.pose);
    samples.push_back({sample, index.nearest(sample)});
  }
  const PartnerLimits limits{
      .reach = 2 * coarse_spread_, .floor = floor_ + coarse_spread_ * coarse_spread_ / 4, .still = still_};
  mode.evidence = evidence_at(mode.pose, samples, scan_.free_space ? &*scan_.free_space : nullptr, model_, limits);
  mode.log_posterior = mode.evidence.log_likelihood - 0.5 * mode.u.squaredNorm();
  return mode;
}

std::vector<PoseMode> PoseSearch::all_coarse_modes(const OrientedIndex& index) const {
  const Eigen::MatrixXd points = starts();
  std::vector<PoseMode> all(static_cast<std::size_t>(points.cols()));
  const auto search_from = [&](std::size_t first, std::size_t count) {
    parallel_for(count, [&](std::size_t i) {
      all[first + i] = coarse_mode(index, points.col(static_cast<Eigen::Index>(first + i)));
    });
  };
  // Where the mean and six more starts all lead to one pose, others do too.
  constexpr std::size_t few = 7;
  search_from(0, std::min(few, all.size()));
  if (all.size() <= few) return all;
  const auto is_same = [&](const PoseMode& mode) { return distance(mode.pose, all[0].pose) < 2 * coarse_spread_; };
  if (std::all_of(all.begin(), all.begin() + few, is_same)) {
    all.resize(few);
  } else {
    search_from(few, all.size() - few);
  }
  return all;
}

std::vector<PoseMode> PoseSearch::coarse_modes() const {
  const OrientedIndex index(model_.surfels().surfels(), coarse_surfels, std::max(reach_, coarse_spread_));
  std::vector<PoseMode> all = all_coarse_modes(index);
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.log_posterior > b.log_posterior; });
  std::vector<PoseMode> kept;
  for (PoseMode& mode : all) {
    const auto is_twin = [&](const PoseMode& other) { return distance(other.pose, mode.pose) < 2 * coarse_spread_; };
    if (std::any_of(kept.begin(), kept.end(), is_twin)) continue;
    kept.push_back(std::move(mode));
    if (kept.size() == most_modes) break;
  }
  parallel_for(kept.size(), [&](std::size_t i) { narrow(kept[i], index); });
  return kept;
}

void PoseSearch::narrow(PoseMode& mode, const OrientedIndex& index) const {
  double spread = coarse_spread_;
  for (int i = 0; i < 6; ++i) {
    mode.u += searching_step(prior_, coarse_pairs(index, medium_, prior_.pose(mode.u), spread), mode.u);
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
    // Beyond a border of the model the surface goes on where nobody has looked: pairs across it would pull sideways.
    const Vec3 offset = pair.target - pair.point;
    if ((offset - pair.normal * pair.residual()).squaredNorm() > cell() * cell()) continue;
    sum.add(pair, pose.translation(), spread);
  }
  return sum;
}

void PoseSearch::follow_pairs(PoseMode& mode, double spread, int settling) const {
  constexpr int iterations = 20;
  for (int i = 0; i < iterations; ++i) {
    const Information pairs = fine_pairs(prior_.pose(mode.u), spread);
    const double worth = worth_of_pair(pairs.pairs);
    // After some steps no direction changes sides, so that the pose cannot swing for ever.
    if (i < settling) {
      mode.axes = pose_axes(prior_, pairs, worth);
      mode.open = OpenDirections::of_prior(mode.axes.open.cols());
    }
    mode.posterior = posterior_step(prior_, pairs, mode.u, mode.axes, mode.open, worth);
    mode.u += mode.posterior.step;
    const double distance = moved(mode.posterior.step);
    // Noise hands samples from surfel to surfel and back for ever; steps that far below a cell are nothing but that.
    mode.converged = spread == 0 && distance < 0.05 * cell();
    if (spread == 0 && distance < 1e-3 * cell()) break;
    if (i % 2 == 1) spread = spread > 0.05 * cell() ? spread / 3 : 0;
  }
  mode.pose = prior_.pose(mode.u);
}

/// Where planes leave directions open, the ends of surfaces and free space may still say something of them: how probable
/// the poses are is asked at deterministic samples of what is known of these directions, again and again, until the
/// samples spread as their weights do (importance sampling). What nothing says anything of stays with the prior.
void PoseSearch::settle_open(PoseMode& mode) const {
  const Eigen::Index dimensions = mode.axes.open.cols();
  const Eigen::MatrixXd points = normal_points(static_cast<int>(dimensions), 24);
  const Eigen::VectorXd rest = mode.u - mode.axes.open * (mode.axes.open.transpose() * mode.u);
  OpenDirections known = OpenDirections::of_prior(dimensions);
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::MatrixXd root = known.covariance.llt().matrixL();
    std::vector<Eigen::VectorXd> places(static_cast<std::size_t>(points.cols()));
    std::vector<double> logs(places.size());
    parallel_for(places.size(), [&](std::size_t i) {
      const Eigen::VectorXd point = points.col(static_cast<Eigen::Index>(i));
      places[i] = known.mean + root * point;
      const PoseEvidence found = evidence(few_, prior_.pose(rest + mode.axes.open * places[i]));
      logs[i] = worth_of_pair(static_cast<int>(found.near)) * found.log_likelihood -
                0.5 * places[i].squaredNorm() + 0.5 * point.squaredNorm();
    });
    const SampleWeights weights = sample_weights(logs, static_cast<double>(2 * dimensions + 2));
    OpenDirections next{Eigen::VectorXd::Zero(dimensions), Eigen::MatrixXd::Zero(dimensions, dimensions)};
    for (std::size_t i = 0; i < places.size(); ++i) next.mean += weights.values[i] * places[i];
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::VectorXd off = places[i] - next.mean;
      next.covariance += weights.values[i] * off * off.transpose();
    }
    // A covariance from so few samples may be too small by chance; deviations fall to a quarter at most.
    next.covariance += 0.0625 * known.covariance;
    known = std::move(next);
    if (weights.power == 1) break;
  }
  mode.open = known;
  mode.u = rest + mode.axes.open * known.mean;
}

void PoseSearch::refine(PoseMode& mode) const {
  constexpr int settling = 6;
  follow_pairs(mode, cell(), settling);
  if (mode.axes.open.cols() == 0) return;
  double squares = 0;  // how far the open directions may put the samples off
  for (const SurfaceSample& sample : coarse_) {
    const Vec3 arm = prior_.mean().linear() * sample.point;
    squares += (effect_of_step(arm) * prior_.root() * mode.axes.open).squaredNorm();
  }
  if (squares <= cell() * cell() * static_cast<double>(coarse_.size())) return;
  settle_open(mode);
  follow_pairs(mode, 0.1 * cell(), 0);
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
                     {.reach = cell(), .floor = floor_, .still = still_});
}

void PoseSearch::weigh(PoseMode& mode) const {
  mode.evidence = evidence(fine_, mode.pose);
  const double worth = worth_of_pair(static_cast<int>(mode.evidence.near));
  mode.log_posterior = worth * mode.evidence.log_likelihood - 0.5 * mode.u.squaredNorm();
  // Laplace: the height of the peak times its width, against that of the prior.
  const Mat6 ratio = Mat6::Identity() + mode.posterior.information * prior_.root() * prior_.root().transpose();
  mode.log_mass = mode.log_posterior - 0.5 * std::log(std::max(1.0, ratio.determinant()));
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
