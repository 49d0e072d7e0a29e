#include "vantage/registration/icp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr double least_cosine = 0.5;  // between the normals of partners

/// Tukey's biweight with a scale from the median residual: full weight for the bulk, none for what lies far outside.
void weigh(std::vector<PlanePair>& pairs, double least_scale, double largest_scale) {
  std::vector<double> residuals(pairs.size());
  std::transform(pairs.begin(), pairs.end(), residuals.begin(),
                 [](const auto& pair) { return std::abs(pair.residual()); });
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  const double scale = std::clamp(1.4826 * *middle, least_scale, largest_scale);
  const double cut = 4.685 * scale;
  for (PlanePair& pair : pairs) {
    const double share = pair.residual() / cut;
    pair.weight = std::abs(share) < 1 ? (1 - share * share) * (1 - share * share) : 0;
  }
}

PointCloud evenly_picked(const PointCloud& cloud, std::size_t most) {
  if (cloud.size() <= most) return cloud;
  PointCloud picked;
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t from = i * cloud.size() / most;
    picked.add(cloud.points[from], cloud.normals[from]);
  }
  return picked;
}

}  // namespace

IcpLevel::IcpLevel(const PointCloud& model, const PointCloud& scan, double cell, std::size_t most_scan_surfels)
    : model_(make_surfels(model, cell)), model_index_(model_.cloud.points) {
  const Surfels of_scan = make_surfels(scan, cell);
  scan_ = evenly_picked(of_scan.cloud, most_scan_surfels);
  flat_share_ = of_scan.flat_share();
}

std::vector<PlanePair> IcpLevel::pairs(const Pose& world_from_sensor, double max_distance) const {
  constexpr std::size_t block_size = 128;
  std::vector<std::vector<PlanePair>> blocks((scan_.size() + block_size - 1) / block_size);
  parallel_for(blocks.size(), [&](std::size_t block) {
    const std::size_t end = std::min(scan_.size(), (block + 1) * block_size);
    for (std::size_t i = block * block_size; i < end; ++i) {
      const Vec3 point = world_from_sensor * scan_.points[i];
      const auto nearest = model_index_.nearest(point);
      if (!nearest || nearest->squared_distance > max_distance * max_distance) continue;
      const Vec3& normal = model_.cloud.normals[nearest->index];
      if (model_.is_flat[nearest->index] == 0) continue;
      const Vec3 scan_normal = world_from_sensor.linear() * scan_.normals[i];
      if (normal.dot(scan_normal) < least_cosine) continue;
      const Vec3 offset = point - model_.cloud.points[nearest->index];
      if ((offset - normal * normal.dot(offset)).norm() > 1.5 * cell()) continue;
      blocks[block].push_back({point, model_.cloud.points[nearest->index], normal, scan_normal});
    }
  });
  std::vector<PlanePair> pairs;
  for (const auto& block : blocks) pairs.insert(pairs.end(), block.begin(), block.end());
  return pairs;
}

IcpResult align(const IcpLevel& level, const Pose& start, const Pose& believed, const MotionFrame& frame,
                const IcpSettings& settings) {
  constexpr std::size_t least_pairs = 10;
  constexpr int settled =
      5;  // iterations after which no direction changes sides, so that the pose does not swing for ever
  const double still = 1e-3 * level.cell();  // a step below this is no progress
  // Noise hands points from surfel to surfel and back for ever; steps so far below a surfel's size are nothing but
  // that.
  const double restless = 0.05 * level.cell();
  IcpResult result;
  result.world_from_sensor = start;
  for (int i = 0; i < settings.max_iterations; ++i) {
    std::vector<PlanePair> pairs = level.pairs(result.world_from_sensor, settings.max_distance);
    if (pairs.size() < least_pairs) return result;
    weigh(pairs, 0.01 * level.cell(), level.cell());
    const Vec6 from_believed = frame.step(believed, result.world_from_sensor);
    NormalEquations equations = normal_equations(pairs, frame);
    equations.matrix += settings.trust * Mat6::Identity();
    equations.right_side -= settings.trust * from_believed;
    if (i < settled) result.directions = directions(equations, settings.least_resistance);
    const Vec6 step = solve(equations, result.directions, from_believed, settings.cost);
    result.world_from_sensor = frame.motion(step) * result.world_from_sensor;
    const Vec6 moved = frame.step(believed, result.world_from_sensor);
    if (moved.norm() > settings.farthest) {
      result.world_from_sensor = frame.motion(moved * (settings.farthest / moved.norm())) * believed;
    }
    result.converged = step.norm() < (i + 1 < settings.max_iterations ? still : restless);
    if (result.converged) break;
  }
  return result;
}

double misfit_of_open_directions(const IcpLevel& level, const IcpResult& result, const MotionFrame& frame,
                                 const Vec6& errors) {
  std::vector<Vec6> effects;
  effects.reserve(level.model().size() + level.scan().size());
  const PointCloud& model = level.model().cloud;
  for (std::size_t i = 0; i < model.size(); ++i)
    effects.push_back(effect_along(model.normals[i], model.points[i], frame));
  const PointCloud& scan = level.scan();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    effects.push_back(effect_along(result.world_from_sensor.linear() * scan.normals[i],
                                   result.world_from_sensor * scan.points[i], frame));
  }
  const Eigen::Matrix<double, 6, Eigen::Dynamic> open = result.directions.open();
  if (open.cols() == 0) return 0;
  // What is believed is all that is known of the open directions: there, its precision alone bounds the error.
  const Eigen::MatrixXd precision = open.transpose() * errors.cwiseAbs2().cwiseInverse().asDiagonal() * open;
  const Eigen::MatrixXd covariance = precision.ldlt().solve(Eigen::MatrixXd::Identity(open.cols(), open.cols()));
  std::vector<double> variances(effects.size());
  std::transform(effects.begin(), effects.end(), variances.begin(), [&](const Vec6& effect) {
    const Eigen::VectorXd along = open.transpose() * effect;
    return along.dot(covariance * along);
  });
  const auto high = variances.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(variances.size()));
  std::nth_element(variances.begin(), high, variances.end());
  return std::sqrt(std::max(0.0, *high));
}

Agreement agreement(const IcpLevel& level, const Pose& world_from_sensor) {
  Agreement agreement;
  double on_model = 0, squares = 0;
  for (const PlanePair& pair : level.pairs(world_from_sensor, 2 * level.cell())) {
    const double share = pair.residual() / level.cell();
    if (std::abs(share) >= 1) continue;
    on_model += 1;
    squares += pair.residual() * pair.residual();
    agreement.score += 1 - share * share;
  }
  // Only flat surfels can lie on the model: noise and edges make others, however much of the surface is shared.
  const auto surfels = static_cast<double>(std::max<std::size_t>(1, level.scan().size()));
  agreement.overlap = std::min(1.0, on_model / std::max(1.0, surfels * level.flat_share()));
  agreement.residual = on_model > 0 ? std::sqrt(squares / on_model) : 0;
  agreement.score /= surfels;
  return agreement;
}

}  // namespace vantage
