#include "vantage/core/random.hpp"

#include <cmath>
#include <numbers>

namespace vantage {
namespace {

// SplitMix64's finaliser spreads neighbouring seeds over the whole range.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

// ln(value) by +, * and / alone, which round the same everywhere. With value = m*2^e and s = (m-1)/(m+1),
// ln m = 2(s + s^3/3 + s^5/5 + ...), where |s| <= 0.172 makes twelve terms enough.
double portable_log(double value) {
  int exponent = 0;
  double mantissa = std::frexp(value, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2) {
    mantissa *= 2;
    --exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);
  double series = 0;
  for (int k = 23; k >= 1; k -= 2) series = series * s * s + 1.0 / k;
  return 2 * s * series + exponent * std::numbers::ln2;
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(mix(seed) + stream)) {}

double Random::normal() {
  while (true) {
    const double u = uniform(-1, 1);
    const double v = uniform(-1, 1);
    const double squared = u * u + v * v;
    if (squared > 0 && squared < 1) return u * std::sqrt(-2 * portable_log(squared) / squared);
  }
}

Vec3 Random::normal3() {
  const double x = normal();
  const double y = normal();
  return {x, y, normal()};
}

Vec3 Random::unit_vector() {
  Vec3 direction = normal3();
  while (direction.norm() < 1e-9) direction = normal3();
  return direction.normalized();
}

}  // namespace vantage
