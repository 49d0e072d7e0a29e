#include "vantage/visibility/splat_kernel.hpp"
#include "vantage/visibility/vector_portable.hpp"

namespace vantage {

std::size_t splat_batch_portable(const BatchView& view, const BatchRegion& region, const std::uint32_t* voxels,
                                 std::size_t count, std::uint32_t* visible) {
  return simd::splat_batches<simd::VectorPortable>(view, region, voxels, count, visible);
}

}  // namespace vantage
