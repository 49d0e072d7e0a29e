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

/// Number of an occupied voxel in the table.
template <class V>
std::size_t rank_of(const NormalTable& table, std::uint32_t voxel) {
  const std::size_t x = voxel & 1023U;
  const std::size_t row = (voxel >> 20U & 1023U) * table.rows_per_layer + (voxel >> 10U & 1023U);
  const std::size_t word = row * table.words_per_row + (x >> 6U);
  const std::uint64_t before = table.occupied[word] & ((std::uint64_t{1} << (x & 63U)) - 1);
  return table.rank_of_word[word] + static_cast<std::size_t>(__builtin_popcountll(before));
}

/// One by one, because the occupied voxels' normals are scattered; without branches that depend on what is seen, which
/// nobody could foresee.
template <class V>
BatchTally tally_voxels(const NormalTable& table, const double (&axis)[3], double min_cosine,
                        const std::uint32_t* voxels, std::size_t count) {
  // Adding and taking away 1.5 * 2^52 rounds to whole numbers, ties to even, as to_fixed_point does.
  constexpr double rounding = 0x1.8p52;
  constexpr std::size_t block = 256;
  std::uint32_t occupied[block];
  std::int64_t cosine_sum = 0;
  std::int64_t left_out = 0;
  BatchTally sum{};
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t end = count - begin < block ? count : begin + block;
    std::size_t kept = 0;
    std::uint64_t kinds = 0;  // four counts of 16 bits
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t kind = voxels[i] >> 30U;
      kinds += std::uint64_t{1} << (16 * kind);
      occupied[kept] = voxels[i];
      kept += kind == 1 ? 1 : 0;
    }
    for (int kind = 0; kind < 4; ++kind) sum.kinds[kind] += static_cast<std::int64_t>(kinds >> (16 * kind) & 0xffffU);
    for (std::size_t i = 0; i < kept; ++i) {
      const double* normal = table.normals + 3 * rank_of<V>(table, occupied[i]);
      const double cosine = -(axis[0] * normal[0] + axis[1] * normal[1] + axis[2] * normal[2]);  // facing_cosine
      if (cosine < min_cosine && (normal[0] != 0 || normal[1] != 0 || normal[2] != 0)) {
        ++left_out;
        continue;
      }
      const double counted = cosine > 0 ? cosine : 0;
      cosine_sum += static_cast<std::int64_t>((counted * 0x1p30 + rounding) - rounding);
    }
  }
  sum.kinds[1] -= left_out;
  sum.cosine_sum = cosine_sum;
  return sum;
}

}  // namespace vantage::simd
