#pragma once

#include "vantage/visibility/coverage.hpp"
#include "vantage/visibility/exposed_voxels.hpp"
#include "vantage/visibility/pixel_frame.hpp"
#include "vantage/visibility/splat_batch.hpp"

namespace vantage {

/// A frame for the vectorised path, with bounds on what single precision can be off. Both arguments must outlive it.
[[nodiscard]] BatchView batch_view(const PixelFrame& frame, Coverage& coverage);

[[nodiscard]] BatchRegion batch_region(const PixelFrame& frame, const Region& region);

}  // namespace vantage
