#pragma once

#include "vantage/core/geometry.hpp"

namespace vantage {

/// -axis.normal, added from x to z: every path computes the cosine by this expression.
[[nodiscard]] inline double facing_cosine(const Vec3& axis, const Vec3& normal) {
  return -(axis.x() * normal.x() + axis.y() * normal.y() + axis.z() * normal.z());
}

}  // namespace vantage
