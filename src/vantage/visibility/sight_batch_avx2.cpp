#include "vantage/visibility/sight_kernel.hpp"
#include "vantage/visibility/vector_avx2.hpp"

namespace vantage {

SplatSights splat_sights_avx2() { return simd::splat_sights<simd::VectorAvx2>; }

}  // namespace vantage
