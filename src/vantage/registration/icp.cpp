#include "vantage/registration/icp.hpp"

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

}  // namespace

IcpLevel::IcpLevel(const PointCloud& model, const PointCloud& scan, double cell)
    : model_(make_surfels(model, cell)), model_index_(model_.cloud.points), scan_(make_surfels(scan, cell)) {}

std::vector<PlanePair> IcpLevel::pairs(const Pose& world_from_sensor, double max_distance, Borders borders) const {
  constexpr std::size_t block_size = 128;
  std::vector<std::vector<PlanePair>> blocks((scan_.size() + block_size - 1) / block_size);
  parallel_for(blocks.size(), [&](std::size_t block) {
    const std::size_t end = std::min(scan_.size(), (block + 1) * block_size);
    for (std::size_t i = block * block_size; i < end; ++i) {
      const Vec3 point = world_from_sensor * scan_.cloud.points[i];
      const auto nearest = model_index_.nearest(point);
      if (!nearest || nearest->squared_distance > max_distance * max_distance) continue;
      const Vec3& normal = model_.cloud.normals[nearest->index];
      if (borders == Borders::left_out && model_.on_border[nearest->index] != 0) continue;
      if (normal.dot(world_from_sensor.linear() * scan_.cloud.normals[i]) < least_cosine) continue;
      blocks[block].push_back({point, model_.cloud.points[nearest->index], normal});
    }
  });
  std::vector<PlanePair> pairs;
  for (const auto& block : blocks) pairs.insert(pairs.end(), block.begin(), block.end());
  return pairs;
}

IcpResult align(const IcpLevel& level, const Pose& start, const Pose& believed, const MotionFrame& frame,
                const IcpSettings& settings) {
  constexpr std::size_t least_pairs = 10;
  const double still = 1e-3 * level.cell();  // a step below this is no progress
  IcpResult result;
  result.world_from_sensor = start;
  for (int i = 0; i < settings.max_iterations; ++i) {
    std::vector<PlanePair> pairs =
        level.pairs(result.world_from_sensor, settings.max_distance, IcpLevel::Borders::left_out);
    if (pairs.size() < least_pairs) return result;
    weigh(pairs, 0.01 * level.cell(), level.cell());
    result.equations = normal_equations(pairs, frame);
    const auto [step, undetermined] =
        solve(result.equations, settings.least_eigenvalue, frame.step(believed, result.world_from_sensor));
    result.undetermined_directions = undetermined;
    result.world_from_sensor = frame.motion(step) * result.world_from_sensor;
    if (step.norm() < still) {
      result.converged = true;
      break;
    }
  }
  return result;
}

NormalEquations resistance(const IcpLevel& level, const Pose& world_from_sensor, const MotionFrame& frame) {
  std::vector<PlanePair> surfels;
  surfels.reserve(level.model().size() + level.scan().size());
  const PointCloud& model = level.model().cloud;
  for (std::size_t i = 0; i < model.size(); ++i)
    surfels.push_back({model.points[i], model.points[i], model.normals[i]});
  const PointCloud& scan = level.scan().cloud;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3 point = world_from_sensor * scan.points[i];
    surfels.push_back({point, point, world_from_sensor.linear() * scan.normals[i]});
  }
  return normal_equations(surfels, frame);
}

Agreement agreement(const IcpLevel& level, const Pose& world_from_sensor) {
  const std::vector<PlanePair> pairs = level.pairs(world_from_sensor, 1.5 * level.cell(), IcpLevel::Borders::included);
  Agreement agreement;
  double on_model = 0, squares = 0;
  for (const PlanePair& pair : pairs) {
    const double share = pair.residual() / level.cell();
    if (std::abs(share) >= 1) continue;
    on_model += 1;
    squares += pair.residual() * pair.residual();
    agreement.score += 1 - share * share;
  }
  const auto surfels = static_cast<double>(std::max<std::size_t>(1, level.scan().size()));
  agreement.overlap = on_model / surfels;
  agreement.residual = on_model > 0 ? std::sqrt(squares / on_model) : 0;
  agreement.score /= surfels;
  return agreement;
}

}  // namespace vantage
