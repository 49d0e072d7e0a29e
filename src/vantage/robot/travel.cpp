#include "vantage/robot/travel.hpp"

#include <cmath>

namespace vantage {

double angle_seen_from(const Vec3& center, const Vec3& a, const Vec3& b) {
  const Vec3 to_a = a - center;
  const Vec3 to_b = b - center;
  return std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b));
}

double Travel::distance(const Vec3& from, const Vec3& to) const {
  return path == Path::orthodromic ? radius * angle_seen_from(center, from, to) : (to - from).norm();
}

double Travel::normalised(const Vec3& from, const Vec3& to) const {
  return angle_seen_from(center, from, to) / std::numbers::pi;
}

}  // namespace vantage
