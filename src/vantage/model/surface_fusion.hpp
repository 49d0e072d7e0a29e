#pragma once

#include "vantage/model/surface_blocks.hpp"
#include "vantage/model/surface_frame.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {

/// How far from the surface a frame says how far it is: noise and the nodes of the cells that the surface crosses lie
/// within.
[[nodiscard]] inline float surface_band(float sigma, float cell) { return 3 * sigma + 1.75F * cell; }

/// Keys of the blocks that the surface in a range image and the band around it touch, as far as they meet the region;
/// sorted.
[[nodiscard]] std::vector<Index3> blocks_near(const SurfaceFrame& frame, const View& view, double cell,
                                              const Box3& region);
/// Tells every node that the image sees how far it lies from the surface, or that it was looked through.
void fuse(SurfaceBlocks& blocks, const SurfaceFrame& frame, const View& view, std::uint16_t number);

}  // namespace vantage
