#pragma once

#include "vantage/visibility/splat_batch.hpp"

// What happens to voxels before and after they are splatted. Only templates on V here, see splat_batch.hpp.
namespace vantage::simd {

template <class V>
std::size_t select_inside(const BatchRegion& region, const std::uint32_t* voxels, std::size_t count,
                          std::uint32_t* inside) {
  using Int = typename V::Int;
  constexpr std::size_t lanes = V::lanes;
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < count; begin += lanes) {
    const std::size_t used = count - begin < lanes ? count - begin : lanes;
    std::uint32_t last_batch[lanes] = {};
    const std::uint32_t* batch = voxels + begin;
    if (used < lanes) {
      __builtin_memcpy(last_batch, batch, used * sizeof *batch);
      batch = last_batch;
    }
    const Int packed = V::load(batch);
    Int outside = V::all(0);
    for (int a = 0; a < 3; ++a) {
      const Int index = (packed >> (10 * a)) & V::all(1023);
      outside |= (index < V::all(region.min[a])) | (index > V::all(region.max[a]));
    }
    const unsigned bits = ~V::lane_bits(outside) & ((2U << (used - 1)) - 1);
    V::store_lanes(inside + kept, packed, bits);
    kept += static_cast<std::size_t>(__builtin_popcount(bits));
  }
  return kept;
}

/// One by one: the occupied voxels' normals are scattered. Compiled with the others for their bit counting.
template <class V>
BatchTally tally_voxels(const NormalTable& table, const double (&axis)[3], double min_cosine,
                        const std::uint32_t* voxels, std::size_t count) {
  // Adding and taking away 1.5 * 2^52 rounds to whole numbers, ties to even, as to_fixed_point does.
  constexpr double rounding = 0x1.8p52;
  BatchTally sum{};
  for (std::size_t i = 0; i < count; ++i) ++sum.kinds[voxels[i] >> 30U];
  for (std::size_t i = 0; i < count; ++i) {
    if (voxels[i] >> 30U != 1) continue;
    const std::size_t x = voxels[i] & 1023U;
    const std::size_t row = (voxels[i] >> 20U & 1023U) * table.rows_per_layer + (voxels[i] >> 10U & 1023U);
    const std::size_t word = row * table.words_per_row + (x >> 6U);
    const std::uint64_t before = table.occupied[word] & ((std::uint64_t{1} << (x & 63U)) - 1);
    const std::size_t rank = table.rank_of_word[word] + static_cast<std::size_t>(__builtin_popcountll(before));
    const double* normal = table.normals + 3 * rank;
    const double cosine = -(axis[0] * normal[0] + axis[1] * normal[1] + axis[2] * normal[2]);  // facing_cosine
    const bool has_normal = normal[0] != 0 || normal[1] != 0 || normal[2] != 0;
    if (has_normal && cosine < min_cosine) {
      --sum.kinds[1];
    } else if (cosine > 0) {
      sum.cosine_sum += static_cast<std::int64_t>((cosine * 0x1p30 + rounding) - rounding);
    }
  }
  return sum;
}

}  // namespace vantage::simd
