#include "vantage/robot/gantry.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/robot/clear_paths.hpp"
#include "vantage/robot/reach.hpp"

namespace vantage {
namespace {

constexpr double angle_tolerance = 1e-3;  // radians that a view may be rolled, and past a limit

bool is_within(double angle, const Eigen::Vector2d& limits_in_degrees) {
  return angle >= radians(limits_in_degrees[0]) - angle_tolerance &&
         angle <= radians(limits_in_degrees[1]) + angle_tolerance;
}

class GantryMobility : public Mobility {
 public:
  GantryMobility(const Gantry& gantry, const Surroundings& surroundings)
      : gantry_(gantry),
        map_(surroundings.map),
        space_(surroundings, gantry.options().head_radius, gantry.options().axes) {
    reach_.body_radius = gantry.options().head_radius;
    reach_.obstacles.assign(surroundings.obstacles.begin(), surroundings.obstacles.end());
  }

  [[nodiscard]] std::optional<std::string> why_unreachable(const View& view) const override {
    if (auto reason = gantry_.why_beyond_limits(view)) return reason;
    return why_infeasible(map_, view, reach_);
  }
  [[nodiscard]] double least_cost(const RobotState& from, const View& to) const override {
    return gantry_.cost((to.position() - from.view.position()).norm(), from.joints, gantry_joints(to));
  }
  [[nodiscard]] Move move(const RobotState& from, const View& to) const override {
    Move move;
    const auto path = space_.path(from.view.position(), to.position());
    if (!path) {
      move.why_not = "no way there through known free space";
      return move;
    }
    const Eigen::VectorXd goal = gantry_joints(to);
    const double length = length_of(*path);
    move.cost = gantry_.cost(length, from.joints, goal);
    double moved = 0;
    for (std::size_t i = 0; i < path->size(); ++i) {
      if (i > 0) moved += ((*path)[i] - (*path)[i - 1]).norm();
      Eigen::VectorXd joints = from.joints + (length > 0 ? moved / length : 1.0) * (goal - from.joints);
      joints.head<3>() = (*path)[i];
      move.path.push_back({gantry_view(joints), joints});
    }
    move.path.back() = {to, goal};
    return move;
  }

 private:
  const Gantry& gantry_;
  const VoxelMap& map_;
  ReachOptions reach_;
  ClearPaths space_;
};

}  // namespace

void GantryOptions::validate() const {
  require(!axes.isEmpty(), "axes: the lower corner must be below the upper one on every axis");
  require(pan[0] < pan[1] && pan[0] >= -180 && pan[1] <= 180, "pan = ", pan.transpose(),
          " degrees: must be two limits in ascending order within -180 .. 180");
  require(tilt[0] < tilt[1] && tilt[0] >= -90 && tilt[1] <= 90, "tilt = ", tilt.transpose(),
          " degrees: must be two limits in ascending order within -90 .. 90");
  require(head_radius >= 0 && std::isfinite(head_radius), "head radius = ", head_radius, " m: must not be negative");
  require(turn_cost >= 0 && std::isfinite(turn_cost), "turn-cost = ", turn_cost, " m/rad: must not be negative");
}

Gantry::Gantry(const GantryOptions& options) : options_(options) { options_.validate(); }

std::unique_ptr<Mobility> Gantry::among(const Surroundings& surroundings) const {
  return std::make_unique<GantryMobility>(*this, surroundings);
}

Eigen::VectorXd gantry_joints(const View& view) {
  // The image's right stays horizontal, also where the axis is vertical and has no azimuth of its own.
  const Vec3 right = view.world_from_sensor.linear().col(0);
  Eigen::VectorXd joints(5);
  joints << view.position(), std::atan2(right.x(), -right.y()),
      std::atan2(view.axis().z(), -view.world_from_sensor.linear().col(1).z());
  return joints;
}

View gantry_view(const Eigen::VectorXd& joints) {
  const double pan = joints[3];
  const double tilt = joints[4];
  const Vec3 right(std::sin(pan), -std::cos(pan), 0);
  const Vec3 axis(std::cos(tilt) * std::cos(pan), std::cos(tilt) * std::sin(pan), std::sin(tilt));
  View view;
  view.world_from_sensor.linear() << right, axis.cross(right), axis;
  view.world_from_sensor.translation() = joints.head<3>();
  return view;
}

std::optional<RobotState> Gantry::state_at(const View& view) const {
  if (why_beyond_limits(view)) return std::nullopt;
  return RobotState{view, gantry_joints(view)};
}

RobotState Gantry::state_near(const View& view) const {
  Eigen::VectorXd joints = gantry_joints(view);
  joints.head<3>() = joints.head<3>().cwiseMax(options_.axes.min()).cwiseMin(options_.axes.max());
  joints[3] = std::clamp(joints[3], radians(options_.pan[0]), radians(options_.pan[1]));
  joints[4] = std::clamp(joints[4], radians(options_.tilt[0]), radians(options_.tilt[1]));
  return {gantry_view(joints), joints};
}

std::optional<std::string> Gantry::why_beyond_limits(const View& view) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double at = view.position()[axis];
    if (at >= options_.axes.min()[axis] && at <= options_.axes.max()[axis]) continue;
    return concat("axis ", "xyz"[axis], " at ", at, " m is beyond its limits ", options_.axes.min()[axis], " .. ",
                  options_.axes.max()[axis]);
  }
  const Eigen::VectorXd joints = gantry_joints(view);
  const double rolled = rotation_angle(gantry_view(joints).world_from_sensor.linear(), view.world_from_sensor.linear());
  if (rolled > angle_tolerance)
    return concat("the head cannot roll, and the view is rolled by ", degrees(rolled), " degrees");
  if (!is_within(joints[3], options_.pan)) {
    return concat("pan ", degrees(joints[3]), " degrees is beyond its limits ", options_.pan[0], " .. ",
                  options_.pan[1]);
  }
  if (!is_within(joints[4], options_.tilt)) {
    return concat("tilt ", degrees(joints[4]), " degrees is beyond its limits ", options_.tilt[0], " .. ",
                  options_.tilt[1]);
  }
  return std::nullopt;
}

double Gantry::cost(double metres, const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  return metres + options_.turn_cost * (to.tail<2>() - from.tail<2>()).cwiseAbs().maxCoeff();
}

}  // namespace vantage
