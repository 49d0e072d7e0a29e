#include "vantage/visibility/splat_kernel.hpp"
#include "vantage/visibility/tally_kernel.hpp"
#include "vantage/visibility/vector_avx2.hpp"

namespace vantage {

SplatKernels splat_kernels_avx2() {
  return {simd::splat_batches<simd::VectorAvx2>, simd::select_inside<simd::VectorAvx2>,
          simd::tally_voxels<simd::VectorAvx2>};
}

}  // namespace vantage
