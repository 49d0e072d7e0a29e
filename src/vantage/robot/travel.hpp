#pragma once

#include "vantage/core/geometry.hpp"

namespace vantage {

/// What a move is counted by: the sphere's great circle, the straight line, or the way that the robot really takes.
enum class TravelKind { orthodromic, straight, path };

/// How the length of a move is counted (paper, section 5.2; spec, section 8).
struct Travel {
  enum class Path {
    orthodromic,  // along the sphere around `center` on which the candidates lie
    straight
  };
  Path path = Path::straight;
  Vec3 center = Vec3::Zero();
  double radius = 1;  // of the sphere, metres

  /// Length of the move in metres.
  [[nodiscard]] double distance(const Vec3& from, const Vec3& to) const;
  /// x of eq. 10: the angle between the positions seen from the center, over pi; in [0, 1].
  [[nodiscard]] double normalised(const Vec3& from, const Vec3& to) const;
};

/// Angle between two positions seen from `center`, radians; 0 where one of them is the center.
[[nodiscard]] double angle_seen_from(const Vec3& center, const Vec3& a, const Vec3& b);

}  // namespace vantage
