#include "vantage/robot/turntable.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/robot/clear_paths.hpp"
#include "vantage/robot/reach.hpp"

namespace vantage {
namespace {

constexpr double turn_tolerance = 1e-3;  // radians that a view may be turned off, and past a limit
constexpr double largest_step = 0.02;    // radians between places of a path

class TurntableMobility : public Mobility {
 public:
  TurntableMobility(const Turntable& table, const Surroundings& surroundings)
      : table_(table),
        map_(surroundings.map),
        // Between two places of a path the sensor is on an arc and the check on its chord: the difference is added.
        space_(surroundings, table.options().head_radius + table.options().radius * largest_step * largest_step / 2,
               std::nullopt) {
    reach_.body_radius = table.options().head_radius;
    reach_.obstacles.assign(surroundings.obstacles.begin(), surroundings.obstacles.end());
  }

  [[nodiscard]] std::optional<std::string> why_unreachable(const View& view) const override {
    if (auto reason = table_.why_beyond_limits(view)) return reason;
    return why_infeasible(map_, view, reach_);
  }
  [[nodiscard]] double least_cost(const RobotState& from, const View& to) const override {
    return cost(table_.difference(from.joints, table_.joints_of(to)));
  }
  /// Both axes at once, or one after the other.
  [[nodiscard]] Move move(const RobotState& from, const View& to) const override {
    const Eigen::Vector2d start = from.joints;
    const Eigen::Vector2d way = table_.difference(start, table_.joints_of(to));
    const Eigen::Vector2d end = start + way;
    Move move;
    for (const std::vector<Eigen::Vector2d>& corners : {std::vector<Eigen::Vector2d>{start, end},
                                                        {start, {end[0], start[1]}, end},
                                                        {start, {start[0], end[1]}, end}}) {
      if (!is_clear(corners)) continue;
      for (const Eigen::Vector2d& joints : corners) move.path.push_back({table_.view_of(joints), joints});
      move.path.front() = from;
      move.path.back() = {to, end};  // a table without end counts its turns on
      move.cost = cost(way);
      return move;
    }
    move.why_not = "neither both axes at once nor one after the other get there through known free space";
    return move;
  }

 private:
  [[nodiscard]] double cost(const Eigen::Vector2d& way) const { return way.cwiseAbs().dot(table_.options().weights); }
  [[nodiscard]] bool is_clear(const std::vector<Eigen::Vector2d>& corners) const {
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const Eigen::Vector2d way = corners[i] - corners[i - 1];
      const int steps = std::max(1, static_cast<int>(std::ceil(way.lpNorm<1>() / largest_step)));
      for (int step = 0; step < steps; ++step) {
        const Eigen::Vector2d a = corners[i - 1] + way * step / steps;
        const Eigen::Vector2d b = corners[i - 1] + way * (step + 1) / steps;
        if (!space_.is_clear(table_.view_of(a).position(), table_.view_of(b).position())) return false;
      }
    }
    return true;
  }

  const Turntable& table_;
  const VoxelMap& map_;
  ReachOptions reach_;
  ClearPaths space_;
};

}  // namespace

void TurntableOptions::validate() const {
  require(center.allFinite(), "turntable-center: must be finite");
  require(radius > 0 && std::isfinite(radius), "arc-radius = ", radius, " m: must be positive");
  require(arc[0] < arc[1] && arc[0] >= -90 && arc[1] <= 90, "arc = ", arc.transpose(),
          " degrees: must be two limits in ascending order within -90 .. 90");
  require(turn[0] < turn[1] && turn[0] >= -180 && turn[1] <= 180, "turn = ", turn.transpose(),
          " degrees: must be two limits in ascending order within -180 .. 180");
  require(head_radius >= 0 && std::isfinite(head_radius), "head radius = ", head_radius, " m: must not be negative");
  require(tolerance > 0, "arc-tolerance = ", tolerance, " m: must be positive");
  require((weights.array() >= 0).all() && weights.allFinite(), "weights: must not be negative");
}

Turntable::Turntable(const TurntableOptions& options) : options_(options) { options_.validate(); }

std::unique_ptr<Mobility> Turntable::among(const Surroundings& surroundings) const {
  return std::make_unique<TurntableMobility>(*this, surroundings);
}

Eigen::Vector2d Turntable::joints_of(const View& view) const {
  const Vec3 offset = view.position() - options_.center;
  return {std::atan2(offset.y(), offset.x()), std::atan2(offset.z(), offset.head<2>().norm())};
}

View Turntable::view_of(const Eigen::Vector2d& joints) const {
  const Vec3 offset(std::cos(joints[1]) * std::cos(joints[0]), std::cos(joints[1]) * std::sin(joints[0]),
                    std::sin(joints[1]));
  return view_towards(options_.center + options_.radius * offset, options_.center);
}

Eigen::Vector2d Turntable::difference(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  Eigen::Vector2d way = to - from;
  const bool turns_without_end = options_.turn[1] - options_.turn[0] >= 360;
  if (turns_without_end) way[0] = std::remainder(way[0], 2 * std::numbers::pi);
  return way;
}

std::optional<RobotState> Turntable::state_at(const View& view) const {
  if (why_beyond_limits(view)) return std::nullopt;
  return RobotState{view, joints_of(view)};
}

RobotState Turntable::state_near(const View& view) const {
  Eigen::Vector2d joints = joints_of(view);
  joints[0] = std::clamp(joints[0], radians(options_.turn[0]), radians(options_.turn[1]));
  joints[1] = std::clamp(joints[1], radians(options_.arc[0]), radians(options_.arc[1]));
  return {view_of(joints), joints};
}

std::optional<std::string> Turntable::why_beyond_limits(const View& view) const {
  const double distance = (view.position() - options_.center).norm();
  if (std::abs(distance - options_.radius) > options_.tolerance) {
    return concat("not on the arc: ", distance, " m from its center instead of ", options_.radius);
  }
  const double off =
      rotation_angle(look_at(view.position(), options_.center).linear(), view.world_from_sensor.linear());
  if (off > turn_tolerance) {
    return concat("the sensor looks at the arc's center and cannot turn by ", degrees(off), " degrees");
  }
  const Eigen::Vector2d joints = joints_of(view);
  const auto is_within = [](double angle, const Eigen::Vector2d& limits) {
    return angle >= radians(limits[0]) - turn_tolerance && angle <= radians(limits[1]) + turn_tolerance;
  };
  if (!is_within(joints[1], options_.arc)) {
    return concat("elevation ", degrees(joints[1]), " degrees is beyond the arc ", options_.arc[0], " .. ",
                  options_.arc[1]);
  }
  if (!is_within(joints[0], options_.turn)) {
    return concat("turn ", degrees(joints[0]), " degrees is beyond the table's limits ", options_.turn[0], " .. ",
                  options_.turn[1]);
  }
  return std::nullopt;
}

}  // namespace vantage
