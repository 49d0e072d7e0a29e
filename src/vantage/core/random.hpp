#pragma once

#include <cstdint>
#include <random>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A seeded stream of random numbers that is the same on every machine and standard library. Pass it by reference.
class Random {
 public:
  /// Streams of one seed are independent: give each use (robot error, depth noise, ...) its own.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  [[nodiscard]] std::uint64_t bits() { return engine_(); }
  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform among 0 .. count-1; `count` must be positive.
  [[nodiscard]] int index(int count) { return static_cast<int>(uniform() * count); }
  /// Standard normal, by Marsaglia's polar method with a logarithm of its own: std::log differs between machines.
  [[nodiscard]] double normal();
  [[nodiscard]] Vec3 normal3();
  [[nodiscard]] Vec3 unit_vector();

 private:
  std::mt19937_64 engine_;
};

}  // namespace vantage
