#pragma once

#include "vantage/visibility/splat_batch.hpp"

// As splat_batch.hpp, for rays that may once pass a grazing voxel.
namespace vantage {

/// The second layer: pixels whose rays have passed a grazing voxel, in strips as those of BatchView; and which
/// voxels are grazing, as a bit plane.
struct GrazingLayer {
  std::uint8_t* passed;  // first strip
  const std::uint64_t* grazing;
  std::size_t rows_per_layer, words_per_row;
};

/// As SplatBatch. BatchView::splat_one has to know the second layer itself.
using SplatSights = std::size_t (*)(const BatchView& view, const GrazingLayer& layer, const BatchRegion& region,
                                    const std::uint32_t* voxels, std::size_t count, std::uint32_t* visible);

[[nodiscard]] SplatSights splat_sights_portable();
[[nodiscard]] SplatSights splat_sights_avx2();
[[nodiscard]] SplatSights splat_sights_avx512();

}  // namespace vantage
