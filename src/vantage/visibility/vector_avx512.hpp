#pragma once

#include <immintrin.h>

#include <cstdint>

namespace vantage::simd {

/// Sixteen lanes. Only for files that are compiled with -mavx512f -mavx512dq.
struct VectorAvx512 {
  static constexpr int lanes = 16;
  using Float = __m512;
  using Int = std::int32_t __attribute__((vector_size(64)));

  struct Double {
    __m512d low, high;
    friend Double operator*(Double a, Double b) { return {a.low * b.low, a.high * b.high}; }
    friend Double operator-(Double a, Double b) { return {a.low - b.low, a.high - b.high}; }
  };

  static Double all(double x) { return {_mm512_set1_pd(x), _mm512_set1_pd(x)}; }
  static Double to_double(Float x) {
    return {_mm512_cvtps_pd(_mm512_castps512_ps256(x)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(x, 1))};
  }
  static Float to_float(Double x) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(x.low)), _mm512_cvtpd_ps(x.high), 1);
  }
  static Double multiply_add(Double a, Double b, Double c) {
    return {_mm512_fmadd_pd(a.low, b.low, c.low), _mm512_fmadd_pd(a.high, b.high, c.high)};
  }
  static Float all(float x) { return _mm512_set1_ps(x); }
  static Int all(std::int32_t x) { return Int(_mm512_set1_epi32(x)); }
  static Int load(const std::uint32_t* from) { return Int(_mm512_loadu_si512(from)); }
  static void store(std::uint32_t* to, Int x) { _mm512_storeu_si512(to, __m512i(x)); }
  static Float to_float(Int x) { return _mm512_cvtepi32_ps(__m512i(x)); }
  static Int truncate(Float x) { return Int(_mm512_cvttps_epi32(x)); }
  static Int floor(Float x) { return Int(_mm512_cvt_roundps_epi32(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC)); }
  static Float multiply_add(Float a, Float b, Float c) { return _mm512_fmadd_ps(a, b, c); }
  static Float min(Float a, Float b) { return _mm512_min_ps(a, b); }
  static Float max(Float a, Float b) { return _mm512_max_ps(a, b); }
  static Int min(Int a, Int b) { return Int(_mm512_min_epi32(__m512i(a), __m512i(b))); }
  static Int max(Int a, Int b) { return Int(_mm512_max_epi32(__m512i(a), __m512i(b))); }
  static Float absolute(Float x) { return _mm512_abs_ps(x); }
  static Int float_to_bits(Float x) { return Int(_mm512_castps_si512(x)); }
  static Float bits_to_float(Int x) { return _mm512_castsi512_ps(__m512i(x)); }
  static Float select(Int mask, Float yes, Float no) {
    return _mm512_mask_mov_ps(no, _mm512_movepi32_mask(__m512i(mask)), yes);
  }
  static Int ones_above(Int counts) { return Int(_mm512_sllv_epi32(_mm512_set1_epi32(-1), __m512i(counts))); }
  static unsigned lane_bits(Int mask) { return _mm512_movepi32_mask(__m512i(mask)); }
  static void store_lanes(std::uint32_t* to, Int x, unsigned bits) {
    // Compressed in a register: some processors are slow at compressing to memory.
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), __m512i(x)));
  }
  /// One word of two vectors' lanes each, the first being the low half.
  static void store_words(std::uint64_t* to, Int low, Int high) {
    _mm512_storeu_si512(to, first_words(low, high));
    _mm512_storeu_si512(to + 8, last_words(low, high));
  }
  /// The lanes whose word has a bit that the eight bytes at base + place do not have.
  static unsigned any_open(const std::uint8_t* base, Int place, Int low, Int high) {
    const __m512i first = _mm512_i32gather_epi64(_mm512_castsi512_si256(__m512i(place)), base, 1);
    const __m512i last = _mm512_i32gather_epi64(_mm512_extracti64x4_epi64(__m512i(place), 1), base, 1);
    const __m512i open_first = _mm512_andnot_si512(first, first_words(low, high));
    const __m512i open_last = _mm512_andnot_si512(last, last_words(low, high));
    return static_cast<unsigned>(_mm512_test_epi64_mask(open_first, open_first)) |
           static_cast<unsigned>(_mm512_test_epi64_mask(open_last, open_last)) << 8U;
  }
  static std::int32_t largest(Int x) { return _mm512_reduce_max_epi32(__m512i(x)); }

 private:
  static __m512i first_words(Int low, Int high) {
    const __m512i order = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    return _mm512_permutex2var_epi32(__m512i(low), order, __m512i(high));
  }
  static __m512i last_words(Int low, Int high) {
    const __m512i order = _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
    return _mm512_permutex2var_epi32(__m512i(low), order, __m512i(high));
  }
};

}  // namespace vantage::simd
