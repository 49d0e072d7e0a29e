#include "vantage/visibility/sight_kernel.hpp"
#include "vantage/visibility/vector_avx512.hpp"

namespace vantage {

SplatSights splat_sights_avx512() { return simd::splat_sights<simd::VectorAvx512>; }

}  // namespace vantage
