#pragma once

#include <cstdint>

namespace vantage::simd {

/// Four lanes in the compiler's own vectors: runs everywhere. The same interface as VectorAvx2 and VectorAvx512.
struct VectorPortable {
  static constexpr int lanes = 4;
  using Float = float __attribute__((vector_size(16)));
  using Int = std::int32_t __attribute__((vector_size(16)));

  using Pair = double __attribute__((vector_size(16)));
  /// As many doubles as lanes.
  struct Double {
    Pair low, high;
    friend Double operator*(Double a, Double b) { return {a.low * b.low, a.high * b.high}; }
    friend Double operator-(Double a, Double b) { return {a.low - b.low, a.high - b.high}; }
  };

  static Double all(double x) { return {Pair{x, x}, Pair{x, x}}; }
  static Double to_double(Float x) {
    return {Pair{static_cast<double>(x[0]), static_cast<double>(x[1])},
            Pair{static_cast<double>(x[2]), static_cast<double>(x[3])}};
  }
  static Float to_float(Double x) {
    return Float{static_cast<float>(x.low[0]), static_cast<float>(x.low[1]), static_cast<float>(x.high[0]),
                 static_cast<float>(x.high[1])};
  }
  static Double multiply_add(Double a, Double b, Double c) { return {a.low * b.low + c.low, a.high * b.high + c.high}; }
  static Float all(float x) { return Float{x, x, x, x}; }
  static Int all(std::int32_t x) { return Int{x, x, x, x}; }
  static Int load(const std::uint32_t* from) {
    Int x;
    __builtin_memcpy(&x, from, sizeof x);
    return x;
  }
  static void store(std::uint32_t* to, Int x) { __builtin_memcpy(to, &x, sizeof x); }
  static Float to_float(Int x) { return __builtin_convertvector(x, Float); }
  static Int truncate(Float x) { return __builtin_convertvector(x, Int); }
  static Int floor(Float x) {
    const Int down = truncate(x);
    return down + (to_float(down) > x);  // a true comparison is -1
  }
  static Float multiply_add(Float a, Float b, Float c) { return a * b + c; }
  static Float min(Float a, Float b) { return a < b ? a : b; }
  static Float max(Float a, Float b) { return a > b ? a : b; }
  static Int min(Int a, Int b) { return a < b ? a : b; }
  static Int max(Int a, Int b) { return a > b ? a : b; }
  static Float absolute(Float x) { return bits_to_float(float_to_bits(x) & all(0x7fffffff)); }
  static Int float_to_bits(Float x) { return reinterpret_cast<Int>(x); }
  static Float bits_to_float(Int x) { return reinterpret_cast<Float>(x); }
  static Float select(Int mask, Float yes, Float no) { return mask ? yes : no; }
  /// All ones shifted left; counts 0..31 per lane.
  static Int ones_above(Int counts) { return all(-1) << counts; }
  /// One bit per lane of a mask.
  static unsigned lane_bits(Int mask) {
    unsigned bits = 0;
    for (int i = 0; i < lanes; ++i) bits |= (mask[i] != 0 ? 1U : 0U) << i;
    return bits;
  }
  /// Writes the lanes whose bit is set one after the other; there must be room for all lanes.
  static void store_lanes(std::uint32_t* to, Int x, unsigned bits) {
    for (int i = 0; i < lanes; ++i) {
      *to = static_cast<std::uint32_t>(x[i]);
      to += bits >> i & 1U;
    }
  }
  /// One word of two vectors' lanes each, the first being the low half.
  static void store_words(std::uint64_t* to, Int low, Int high) {
    for (int i = 0; i < lanes; ++i) to[i] = word(low[i], high[i]);
  }
  /// The lanes whose word has a bit that the eight bytes at base + place do not have.
  static unsigned any_open(const std::uint8_t* base, Int place, Int low, Int high) {
    unsigned bits = 0;
    for (int i = 0; i < lanes; ++i) {
      std::uint64_t covered;
      __builtin_memcpy(&covered, base + place[i], sizeof covered);
      bits |= ((word(low[i], high[i]) & ~covered) != 0 ? 1U : 0U) << i;
    }
    return bits;
  }
  static std::int32_t largest(Int x) {
    std::int32_t most = x[0];
    for (int i = 1; i < lanes; ++i) most = x[i] > most ? x[i] : most;
    return most;
  }

 private:
  static std::uint64_t word(std::int32_t low, std::int32_t high) {
    return static_cast<std::uint32_t>(low) | static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32U;
  }
};

}  // namespace vantage::simd
