#pragma once

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

// The shapes behind make_object, at sizes of their own. All are closed and face outwards; z is up.

[[nodiscard]] TriangleMesh sphere_shape();
/// With a bent stem.
[[nodiscard]] TriangleMesh pear_shape();
[[nodiscard]] TriangleMesh banana_shape();
/// Open inside, with a handle.
[[nodiscard]] TriangleMesh mug_shape();
/// One closed loop of bent tubes along the edges of a cube that stands on a corner.
[[nodiscard]] TriangleMesh sgi_logo_shape();

}  // namespace vantage
