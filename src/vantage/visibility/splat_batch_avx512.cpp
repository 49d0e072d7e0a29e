#include "vantage/visibility/splat_kernel.hpp"
#include "vantage/visibility/tally_kernel.hpp"
#include "vantage/visibility/vector_avx512.hpp"

namespace vantage {

SplatKernels splat_kernels_avx512() {
  return {simd::splat_batches<simd::VectorAvx512>, simd::select_inside<simd::VectorAvx512>,
          simd::tally_voxels<simd::VectorAvx512>};
}

}  // namespace vantage
