#include "vantage/registration/evidence.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// What a match is worth in the likelihood. A surface that is met at random within a metre lies within 10 mm / sqrt(2
/// pi) of another with a probability of e^-4.6; and a sensor is wrong by more than its noise in one of a hundred
/// samples. Residuals of three standard deviations cost as much, so that what is no match counts nothing.
constexpr double worth = 4.5;

/// What earlier scans say of a place.
FreeSpace::Answer seen_by_earlier_scans(const Vec3& point, std::span<const PosedFreeSpace> spaces) {
  FreeSpace::Answer seen = FreeSpace::Answer::unknown;
  for (const PosedFreeSpace& space : spaces) {
    const FreeSpace::Answer answer = space.space.at(space.sensor_from_world * point);
    if (answer == FreeSpace::Answer::free) return answer;
    if (answer != FreeSpace::Answer::unknown) seen = answer;
  }
  return seen;
}

/// True where the sample may be a known surface that is misplaced by the pose.
bool is_explained(const SurfaceSample& sample, const PartnerLimits& limits) {
  if (limits.known == nullptr) return true;
  const SurfaceSample* nearest = limits.known->nearest(sample);
  return nearest != nullptr &&
         (nearest->point - sample.point).squaredNorm() < limits.explained_within * limits.explained_within;
}

}  // namespace

PoseEvidence evidence_at(const Pose& world_from_sensor, std::span<const PlacedSample> samples, const FreeSpace* own,
                         const RegisteredSurface& model, const PartnerLimits& limits) {
  PoseEvidence evidence;
  evidence.asked = static_cast<double>(samples.size());
  for (const auto& [sample, partner] : samples) {
    bool is_near = false;
    if (partner != nullptr) {
      const SurfacePair pair = surface_pair(sample, *partner, limits.floor);
      const Vec3 offset = pair.target - pair.point;
      const double residual = pair.residual();
      if ((offset - residual * pair.normal).squaredNorm() < limits.reach * limits.reach) {
        is_near = true;
        evidence.near += 1;
        const double cost = residual * residual / (2 * pair.variance);
        if (cost < worth) {
          evidence.on_surface += 1;
          evidence.squared_distances += residual * residual;
          evidence.log_likelihood += worth - cost;
          continue;
        }
      }
    }
    if (limits.still && !limits.still->contains(sample.point)) continue;
    const FreeSpace::Answer seen = seen_by_earlier_scans(sample.point, model.free_spaces());
    if (seen == FreeSpace::Answer::unknown && !is_near) evidence.unseen += 1;
    const bool is_new = seen == FreeSpace::Answer::free && !is_explained(sample, limits);
    if (seen == FreeSpace::Answer::unknown || is_new) continue;
    evidence.looked_at += 1;
    if (seen != FreeSpace::Answer::free) continue;
    evidence.in_free_space += 1;
    evidence.log_likelihood -= worth;
  }
  if (own == nullptr) return evidence;
  const std::span<const SurfaceSample> surfels = model.surfels().surfels();
  const Pose sensor_from_world = world_from_sensor.inverse();
  const std::size_t step = surfels.size() / std::max<std::size_t>(1, samples.size()) + 1;
  for (std::size_t i = 0; i < surfels.size(); i += step) {
    if (limits.still && !limits.still->contains(surfels[i].point)) continue;
    const FreeSpace::Answer answer = own->at(sensor_from_world * surfels[i].point);
    if (answer == FreeSpace::Answer::unknown) continue;
    evidence.looked_at += 1;
    if (answer != FreeSpace::Answer::free) continue;
    evidence.in_free_space += 1;
    evidence.log_likelihood -= worth;
  }
  return evidence;
}

}  // namespace vantage
