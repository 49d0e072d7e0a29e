#pragma once

#include <optional>
#include <vector>

#include "vantage/robot/box_tree.hpp"
#include "vantage/robot/robot_model.hpp"

namespace vantage {

/// Where the centre of a ball can be and how it gets from one place to another without touching what is not known to
/// be free.
class ClearPaths {
 public:
  /// `radius` of the ball in metres; its centre stays inside `workspace`.
  ClearPaths(const Surroundings& surroundings, double radius, const std::optional<Box3>& workspace);

  /// Whether the ball keeps clear everywhere on the way. Clear is a twentieth of a voxel more than not touching: with
  /// it each step may be as long as there is room, and nothing between two steps is missed.
  [[nodiscard]] bool is_clear(const Vec3& from, const Vec3& to) const;
  /// Corner points of a short way between two places: straight where that is clear, else the shortest on a lattice,
  /// pulled tight. Nothing where the lattice knows no way.
  [[nodiscard]] std::optional<std::vector<Vec3>> path(const Vec3& from, const Vec3& to) const;
  /// Room around the ball, metres; negative where it touches.
  [[nodiscard]] double room(const Vec3& center) const { return solids_.distance(center) - radius_; }

 private:
  /// Straight from each corner to the farthest one that can be seen from there.
  [[nodiscard]] std::vector<Vec3> shortcut(const std::vector<Vec3>& way) const;
  /// The corner moved towards the straight line between its neighbours as far as both pieces stay clear.
  [[nodiscard]] Vec3 slid(const Vec3& before, const Vec3& corner, const Vec3& after) const;
  [[nodiscard]] std::vector<Vec3> pulled_tight(const std::vector<Vec3>& way) const;

  BoxTree solids_;
  double radius_;
  double least_room_;
  std::optional<Box3> workspace_;
};

/// Metres along the corner points.
[[nodiscard]] double length_of(const std::vector<Vec3>& way);

}  // namespace vantage
