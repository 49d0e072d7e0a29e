#include "vantage/planning/registrability.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr double points_per_voxel = 4;  // along an edge, that the fused cloud keeps
constexpr std::size_t views_at_a_time = 16;

double standard_normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

}  // namespace

double chance_of_acceptance(double known_points) {
  // Fitted in voxels of 20 mm, 2 m from a camera of 45 x 45 degrees and 320 x 320 pixels.
  constexpr double points_of_a_voxel = 14.92;
  constexpr double most = 0.94, offset = 13.4, by_root_of_count = 226.5, least = 0.06;
  const double chance =
      most / (1 + std::exp(by_root_of_count / std::sqrt(known_points / points_of_a_voxel + 1) - offset));
  return std::max(least, chance);
}

PoseError::Vector effect_of_error(const View& view, const Vec3& point, const Vec3& normal) {
  const Vec3 turn = view.world_from_sensor.linear().transpose() * (point - view.position()).cross(normal);
  PoseError::Vector effect;
  // Pan turns about y, tilt about x, roll about z of the sensor.
  effect << normal, turn.y(), turn.x(), turn.z();
  return effect;
}

PoseError::Matrix posterior_covariance(const PoseError::Matrix& prior, const PoseError::Matrix& information) {
  const PoseError::Matrix root = root_of(prior);
  const PoseError::Matrix whitened = PoseError::Matrix::Identity() + root.transpose() * information * root;
  return root * whitened.ldlt().solve(PoseError::Matrix(root.transpose()));
}

double probability_below(const PoseError::Matrix& weights, const PoseError::Matrix& covariance, double limit) {
  const PoseError::Matrix product = weights * covariance;
  const double mean = product.trace();
  const double variance = 2 * (product * product).trace();
  if (mean <= 0 || variance <= 0) return 1;
  const double freedoms = 2 * mean * mean / variance;
  const double spread = 2 / (9 * freedoms);
  return standard_normal_cdf((std::cbrt(limit / mean) - (1 - spread)) / std::sqrt(spread));
}

KnownSurface::KnownSurface(const VoxelMap& map, const SensorModel& sensor) : map_(map), sensor_(sensor) {
  sensor_.validate();
  for (const Index3& voxel : map.occupied_voxels()) {
    const Vec3 normal = map.surface(voxel)->normal();
    if (!normal.isZero(0)) patches_.push_back({map.grid().center(voxel), normal});
  }
}

PoseError::Matrix KnownSurface::mean_effect(const View& view) const {
  PoseError::Matrix sum = PoseError::Matrix::Zero();
  for (const Patch& patch : patches_) {
    const PoseError::Vector effect = effect_of_error(view, patch.point, patch.normal);
    sum.noalias() += effect * effect.transpose();
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, patches_.size()));
}

Registrability KnownSurface::registrability(const View& view, std::span<const Index3> seen,
                                            const PoseError& error) const {
  const double voxel = map_.grid().length;
  const double rounding = voxel / points_per_voxel / std::sqrt(12.0);
  PoseError::Matrix information = PoseError::Matrix::Zero();
  for (const Index3& index : seen) {
    const SurfaceVoxel* surface = map_.surface(index);
    if (surface == nullptr) continue;
    const Vec3 normal = surface->normal();
    if (normal.isZero(0)) continue;
    const Vec3 point = map_.grid().center(index);
    const Vec3 sight = point - view.position();
    const double cosine = std::abs(normal.dot(sight)) / sight.norm();
    // The depth's error along the axis, as far as it goes along the normal.
    const double along_normal = std::abs(normal.dot(view.axis())) * sensor_.sigma(view.axis().dot(sight), cosine);
    const double deviation = std::hypot(along_normal, rounding);
    const PoseError::Vector effect = effect_of_error(view, point, normal) / deviation;
    information.noalias() += effect * effect.transpose();
  }
  const PoseError::Matrix covariance = posterior_covariance(error.covariance, information);
  const PoseError::Matrix weights = mean_effect(view);
  const double limit = voxel / 2;
  return {probability_below(weights, covariance, limit * limit),
          std::sqrt(std::max(0.0, (weights * covariance).trace()))};
}

void RegistrabilityOptions::validate() const {
  sensor.validate();
  require(least_probability >= 0 && least_probability <= 1, "registrable = ", least_probability,
          ": must be a probability in [0, 1]");
  require(least_overlap >= 0 && least_overlap <= 1, "least-overlap = ", least_overlap, ": must be a share in [0, 1]");
}

RegistrableViews rank_by_registrability(const ViewEvaluation& problem, std::vector<Evaluation> ranked,
                                        const RegistrabilityOptions& options, int stop_occplane) {
  const KnownSurface surface(problem.map, options.sensor);
  const auto is_of_use = [&](const Evaluation& each) { return each.seen.occplane > stop_occplane; };
  const auto is_admissible = [&](const Evaluation& each) {
    return is_of_use(each) && each.registrability->probability >= options.least_probability &&
           each.factors.x_oc >= options.least_overlap;
  };
  RegistrableViews result;
  const RayGrid rays = problem.camera.rays();
  const double pixel = std::max(2 * rays.x_half / rays.resolution.columns, 2 * rays.y_half / rays.resolution.rows);
  double best_score = 0;  // of admissible views
  bool is_settled = false;
  for (std::size_t begin = 0; begin < ranked.size() && !is_settled; begin += views_at_a_time) {
    const std::size_t end = std::min(ranked.size(), begin + views_at_a_time);
    parallel_for(end - begin, [&](std::size_t i) {
      Evaluation& each = ranked[begin + i];
      const std::vector<Index3> seen =
          problem.visibility.visible_voxels(problem.camera, each.view, problem.ideal(each.candidate));
      const PoseError error = options.error->of_move(problem.current, each.view);
      each.registrability = surface.registrability(each.view, seen, error);
      if (!error.covariance.isZero(0)) {
        const auto known = std::count_if(
            seen.begin(), seen.end(), [&](const Index3& voxel) { return problem.map.label(voxel) == Label::occupied; });
        const double spacing = pixel * (each.view.position() - problem.candidates.center).norm();
        const double points_of_a_voxel = std::pow(problem.map.grid().length / spacing, 2);
        each.registrability->probability *= chance_of_acceptance(points_of_a_voxel * static_cast<double>(known));
      }
      if (each.score > 0) each.score *= each.registrability->probability;
    });
    for (std::size_t i = begin; i < end; ++i) {
      if (is_admissible(ranked[i])) best_score = std::max(best_score, ranked[i].score);
      if (is_of_use(ranked[i]))
        result.best_probability = std::max(result.best_probability, ranked[i].registrability->probability);
    }
    is_settled = end < ranked.size() && best_score > 0 && ranked[end].score <= best_score;
    if (is_settled) ranked.resize(end);
  }
  // Admissible ones, those that are not but have a chance, and the rest, each in their order.
  std::vector<Evaluation> admissible, possible, others;
  for (Evaluation& each : ranked) {
    const bool has_chance = is_of_use(each) && each.registrability->probability >= options.fair_chance;
    (is_admissible(each) ? admissible : has_chance ? possible : others).push_back(std::move(each));
  }
  if (admissible.empty() && possible.empty()) return result;
  for (std::vector<Evaluation>* group : {&admissible, &possible, &others}) {
    rank(*group);
    result.ranking.insert(result.ranking.end(), group->begin(), group->end());
  }
  return result;
}

}  // namespace vantage
