#include "vantage/visibility/splat_kernel.hpp"
#include "vantage/visibility/tally_kernel.hpp"
#include "vantage/visibility/vector_portable.hpp"

namespace vantage {

SplatKernels splat_kernels_portable() {
  return {simd::splat_batches<simd::VectorPortable>, simd::select_inside<simd::VectorPortable>,
          simd::tally_voxels<simd::VectorPortable>};
}

}  // namespace vantage
