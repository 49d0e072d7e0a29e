#include "vantage/core/random.hpp"

#include <cmath>

namespace vantage {
namespace {

// SplitMix64's finaliser spreads neighbouring seeds over the whole range.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(mix(seed) + stream)) {}

double Random::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
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
