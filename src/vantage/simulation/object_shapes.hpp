#pragma once

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

// The shapes behind make_object, at sizes of their own. All are closed and face outwards.

[[nodiscard]] TriangleMesh sphere_shape();
[[nodiscard]] TriangleMesh mug_shape();

}  // namespace vantage
