#pragma once

#include <immintrin.h>

#include <cstdint>

namespace vantage::simd {

/// Eight lanes. Only for files that are compiled with -mavx2 -mfma.
struct VectorAvx2 {
  static constexpr int lanes = 8;
  using Float = __m256;
  using Int = std::int32_t __attribute__((vector_size(32)));

  struct Double {
    __m256d low, high;
    friend Double operator*(Double a, Double b) { return {a.low * b.low, a.high * b.high}; }
    friend Double operator-(Double a, Double b) { return {a.low - b.low, a.high - b.high}; }
  };

  static Double all(double x) { return {_mm256_set1_pd(x), _mm256_set1_pd(x)}; }
  static Double to_double(Float x) {
    return {_mm256_cvtps_pd(_mm256_castps256_ps128(x)), _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1))};
  }
  static Float to_float(Double x) { return _mm256_set_m128(_mm256_cvtpd_ps(x.high), _mm256_cvtpd_ps(x.low)); }
  static Double multiply_add(Double a, Double b, Double c) {
    return {_mm256_fmadd_pd(a.low, b.low, c.low), _mm256_fmadd_pd(a.high, b.high, c.high)};
  }
  static Float all(float x) { return _mm256_set1_ps(x); }
  static Int all(std::int32_t x) { return Int(_mm256_set1_epi32(x)); }
  static Int load(const std::uint32_t* from) { return Int(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))); }
  static void store(std::uint32_t* to, Int x) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), __m256i(x)); }
  static Float to_float(Int x) { return _mm256_cvtepi32_ps(__m256i(x)); }
  static Int truncate(Float x) { return Int(_mm256_cvttps_epi32(x)); }
  static Int floor(Float x) { return truncate(_mm256_floor_ps(x)); }
  static Float multiply_add(Float a, Float b, Float c) { return _mm256_fmadd_ps(a, b, c); }
  static Float min(Float a, Float b) { return _mm256_min_ps(a, b); }
  static Float max(Float a, Float b) { return _mm256_max_ps(a, b); }
  static Int min(Int a, Int b) { return Int(_mm256_min_epi32(__m256i(a), __m256i(b))); }
  static Int max(Int a, Int b) { return Int(_mm256_max_epi32(__m256i(a), __m256i(b))); }
  static Float absolute(Float x) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), x); }
  static Int float_to_bits(Float x) { return Int(_mm256_castps_si256(x)); }
  static Float bits_to_float(Int x) { return _mm256_castsi256_ps(__m256i(x)); }
  static Float select(Int mask, Float yes, Float no) {
    return _mm256_blendv_ps(no, yes, _mm256_castsi256_ps(__m256i(mask)));
  }
  static Int ones_above(Int counts) { return Int(_mm256_sllv_epi32(_mm256_set1_epi32(-1), __m256i(counts))); }
  static unsigned lane_bits(Int mask) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(__m256i(mask))));
  }
  static void store_lanes(std::uint32_t* to, Int x, unsigned bits) {
    // The numbers of the lanes, as bytes: first one byte of ones for each bit, then those bytes moved together.
    const std::uint64_t bytes = _pdep_u64(bits, 0x0101010101010101U) * 0xffU;
    const __m128i order = _mm_cvtsi64_si128(static_cast<long long>(_pext_u64(0x0706050403020100U, bytes)));
    store(to, Int(_mm256_permutevar8x32_epi32(__m256i(x), _mm256_cvtepu8_epi32(order))));
  }
  static void store_words(std::uint64_t* to, Int low, Int high) {
    auto* at = reinterpret_cast<__m256i*>(to);
    _mm256_storeu_si256(at, first_words(low, high));
    _mm256_storeu_si256(at + 1, last_words(low, high));
  }
  static unsigned any_open(const std::uint8_t* base, Int place, Int low, Int high) {
    const auto* from = reinterpret_cast<const long long*>(base);
    const __m256i first = _mm256_i32gather_epi64(from, _mm256_castsi256_si128(__m256i(place)), 1);
    const __m256i last = _mm256_i32gather_epi64(from, _mm256_extracti128_si256(__m256i(place), 1), 1);
    return words_set(_mm256_andnot_si256(first, first_words(low, high))) |
           words_set(_mm256_andnot_si256(last, last_words(low, high))) << 4U;
  }
  static std::int32_t largest(Int x) {
    __m128i half = _mm_max_epi32(_mm256_castsi256_si128(__m256i(x)), _mm256_extracti128_si256(__m256i(x), 1));
    half = _mm_max_epi32(half, _mm_shuffle_epi32(half, 0x4e));
    half = _mm_max_epi32(half, _mm_shuffle_epi32(half, 0xb1));
    return _mm_cvtsi128_si32(half);
  }

 private:
  static __m256i first_words(Int low, Int high) {
    const __m256i even = _mm256_unpacklo_epi32(__m256i(low), __m256i(high));
    return _mm256_permute2x128_si256(even, _mm256_unpackhi_epi32(__m256i(low), __m256i(high)), 0x20);
  }
  static __m256i last_words(Int low, Int high) {
    const __m256i even = _mm256_unpacklo_epi32(__m256i(low), __m256i(high));
    return _mm256_permute2x128_si256(even, _mm256_unpackhi_epi32(__m256i(low), __m256i(high)), 0x31);
  }
  /// One bit per word that is not zero.
  static unsigned words_set(__m256i words) {
    const __m256i is_zero = _mm256_cmpeq_epi64(words, _mm256_setzero_si256());
    return ~static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(is_zero))) & 15U;
  }
};

}  // namespace vantage::simd
