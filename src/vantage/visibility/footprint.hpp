#pragma once

#include "vantage/visibility/coverage.hpp"
#include "vantage/visibility/pixel_frame.hpp"

namespace vantage {

/// Covers the open pixels whose rays pass the voxel; true where there are any. Any voxel, any camera: this is the path
/// in double precision, row by row, for the voxels that the vectorised one hands on.
[[nodiscard]] bool splat(const PixelFrame& frame, const Index3& voxel, Coverage& coverage);

/// The same for a voxel that rays may pass once (Coverage::pass_row()).
[[nodiscard]] bool splat_once(const PixelFrame& frame, const Index3& voxel, Coverage& ended, Coverage& passed);

}  // namespace vantage
