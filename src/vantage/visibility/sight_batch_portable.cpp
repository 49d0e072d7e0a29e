#include "vantage/visibility/sight_kernel.hpp"
#include "vantage/visibility/vector_portable.hpp"

namespace vantage {

SplatSights splat_sights_portable() { return simd::splat_sights<simd::VectorPortable>; }

}  // namespace vantage
