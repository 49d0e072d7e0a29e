#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Where a robot is: its sensor, and the joints that hold it there (none for a free flyer).
struct RobotState {
  View view;
  Eigen::VectorXd joints = {};  // radians or metres, as the robot's joints are
};

/// What a robot must not touch: voxels that are not known to be empty, and known solids.
struct Surroundings {
  const VoxelMap& map;
  std::span<const Box3> obstacles = {};
};

/// A move, or why there is none.
struct Move {
  std::vector<RobotState> path;  // from where the robot is to the goal; in between the joints move straight, or the
                                 // position where there are none; empty where no move was found
  double cost = 0;               // in RobotModel::cost_unit()
  std::string why_not;           // why no move was found

  [[nodiscard]] bool possible() const { return !path.empty(); }
};

/// What a robot can do among the given surroundings. Every answer depends on the question alone, so that several
/// threads may ask.
class Mobility {
 public:
  Mobility() = default;
  Mobility(const Mobility&) = delete;
  Mobility& operator=(const Mobility&) = delete;
  virtual ~Mobility() = default;

  /// Why the robot cannot be at `view`, or nothing where it can.
  [[nodiscard]] virtual std::optional<std::string> why_unreachable(const View& view) const = 0;
  /// No move to `to` costs less than this: its cost if nothing were in the way. `to` must be reachable.
  [[nodiscard]] virtual double least_cost(const RobotState& from, const View& to) const = 0;
  /// A move that touches nothing, as cheap as it can be found. `to` must be reachable.
  [[nodiscard]] virtual Move move(const RobotState& from, const View& to) const = 0;
};

/// A kind of robot with its limits: what planning has to know of it (spec, section 2).
class RobotModel {
 public:
  RobotModel() = default;
  RobotModel(const RobotModel&) = delete;
  RobotModel& operator=(const RobotModel&) = delete;
  virtual ~RobotModel() = default;

  /// The surroundings' map must outlive the answer and not change meanwhile.
  [[nodiscard]] virtual std::unique_ptr<Mobility> among(const Surroundings& surroundings) const = 0;
  /// Where the robot waits before its first move; nothing for robots that begin at any view.
  [[nodiscard]] virtual std::optional<RobotState> home() const { return std::nullopt; }
  /// The state behind a view where only the view is known; nothing where the robot cannot be there.
  [[nodiscard]] virtual std::optional<RobotState> state_at(const View& view) const { return RobotState{view}; }
  /// Where the robot is thought to be when another robot or a person put the sensor to `view`, which it cannot hold
  /// itself.
  [[nodiscard]] virtual RobotState state_near(const View& view) const { return home().value_or(RobotState{view}); }
  /// What costs are counted in: "m" or "rad".
  [[nodiscard]] virtual std::string cost_unit() const { return "m"; }
};

}  // namespace vantage
