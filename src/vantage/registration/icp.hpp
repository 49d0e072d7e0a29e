#pragma once

#include <limits>
#include <vector>

#include "vantage/registration/normal_equations.hpp"
#include "vantage/registration/point_index.hpp"
#include "vantage/registration/surfels.hpp"

namespace vantage {

/// Model and scan at one resolution.
class IcpLevel {
 public:
  /// Both clouds reduced to surfels of side `cell`; the model in the world frame, the scan in the sensor frame. Of the
  /// scan's surfels at most `most_scan_surfels`, evenly picked, are used: more say no more about six numbers.
  IcpLevel(const PointCloud& model, const PointCloud& scan, double cell, std::size_t most_scan_surfels = 4000);

  [[nodiscard]] double cell() const { return model_.cell; }
  [[nodiscard]] const Surfels& model() const { return model_; }
  [[nodiscard]] const PointCloud& scan() const { return scan_; }
  /// Share of the scan's surfels that are flat.
  [[nodiscard]] double flat_share() const { return flat_share_; }

  /// Each scan surfel with the model surfel nearest to it, where that is flat, nearer than `max_distance`, faces the
  /// same way and lies opposite: seen from it, the scan surfel is at most one and a half cells off its normal. (Beyond
  /// a border of the model the surface goes on where nobody has looked; pairs across it would pull sideways.)
  [[nodiscard]] std::vector<PlanePair> pairs(const Pose& world_from_sensor, double max_distance) const;

 private:
  Surfels model_;
  PointIndex model_index_;
  PointCloud scan_;
  double flat_share_ = 1;
};

struct IcpSettings {
  double max_distance = 0;      // between partners, metres
  double least_resistance = 0;  // see directions()
  int max_iterations = 0;
  /// From the believed pose that is plausible, metres (RMS over the scan's points).
  double farthest = std::numeric_limits<double>::infinity();
  Vec6 cost = rotation_averse_cost();  // of moving along open directions, see solve()
  double trust = 0;                    // in the believed pose, as resistance to moving away from it
};

struct IcpResult {
  Pose world_from_sensor = Pose::Identity();
  bool converged = false;
  Directions directions;  // of the last iteration
};

/// Iterates from `start`; directions that the pairs leave open are drawn to `believed`.
[[nodiscard]] IcpResult align(const IcpLevel& level, const Pose& start, const Pose& believed, const MotionFrame& frame,
                              const IcpSettings& settings);

/// How far model and scan may visibly be off each other in the open directions, where nothing but a believed pose with
/// the standard deviations `errors` (positive, per component of a step) speaks for the result: the distance along the
/// normals that 99.5 % of all surfels stay below, in the worst open direction. Metres; near 0 where the whole shape
/// slides in itself, as a sphere does.
[[nodiscard]] double misfit_of_open_directions(const IcpLevel& level, const IcpResult& result, const MotionFrame& frame,
                                               const Vec6& errors);

/// How well the scan lies on the model at a pose.
struct Agreement {
  double overlap = 0;   // share of the scan's surfels on the model
  double residual = 0;  // RMS distance of the overlap to the model's planes, metres
  double score = 0;     // share of the surfels, each counted by how close it is
};

[[nodiscard]] Agreement agreement(const IcpLevel& level, const Pose& world_from_sensor);

}  // namespace vantage
