#include "vantage/registration/surfel_map.hpp"

#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

struct CellKey {
  std::int64_t x, y, z;

  /// 21 bits per axis, never 0: a lattice of two million cells either way repeats itself, which is far beyond any
  /// scene.
  [[nodiscard]] std::uint64_t packed() const {
    constexpr std::int64_t middle = 1 << 20, mask = (1 << 21) - 1;
    return 1 + ((static_cast<std::uint64_t>((x + middle) & mask) << 42) |
                (static_cast<std::uint64_t>((y + middle) & mask) << 21) |
                static_cast<std::uint64_t>((z + middle) & mask));
  }
};

CellKey cell_key(const Vec3& point, double cell) {
  const auto index = [cell](double value) { return static_cast<std::int64_t>(std::floor(value / cell)); };
  return {index(point.x()), index(point.y()), index(point.z())};
}

std::size_t hash_of(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9e3779b97f4a7c15ULL;
  key ^= key >> 29;
  key *= 0xbf58476d1ce4e5b9ULL;
  return static_cast<std::size_t>(key ^ (key >> 32));
}

}  // namespace

SurfelMap::SurfelMap(double cell) : cell_(cell), slots_(1024) {
  require(cell > 0 && std::isfinite(cell), "surfel map: cell = ", cell, " m: must be positive");
}

std::size_t SurfelMap::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hash_of(key) & mask;
  while (slots_[i].key != 0 && slots_[i].key != key) i = (i + 1) & mask;
  return i;
}

void SurfelMap::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (slot.key != 0) slots_[slot_of(slot.key)] = slot;
  }
}

void SurfelMap::add(const SurfaceSample& sample) {
  if (2 * used_ >= slots_.size()) grow();
  const std::uint64_t key = cell_key(sample.point, cell_).packed();
  Slot& slot = slots_[slot_of(key)];
  if (slot.key == 0) {
    slot.key = key;
    ++used_;
  }
  int last = -1, same = slot.first, sides = 0;
  while (same >= 0 && surfels_[static_cast<std::size_t>(same)].normal.dot(sample.normal) < least_cosine) {
    last = same;
    same = next_[static_cast<std::size_t>(same)];
    ++sides;
  }
  if (same < 0) {
    if (sides >= most_sides) return;
    (last >= 0 ? next_[static_cast<std::size_t>(last)] : slot.first) = static_cast<int>(surfels_.size());
    surfels_.push_back(sample);
    const double weight = 1 / std::max(sample.sigma * sample.sigma, 1e-18);
    normal_sums_.push_back(weight * sample.normal);
    weights_.push_back(weight);
    next_.push_back(-1);
    return;
  }
  const auto i = static_cast<std::size_t>(same);
  SurfaceSample& surfel = surfels_[i];
  const double weight = 1 / std::max(sample.sigma * sample.sigma, 1e-18);
  weights_[i] += weight;
  surfel.point += weight / weights_[i] * (sample.point - surfel.point);
  normal_sums_[i] += weight * sample.normal;
  surfel.normal = normal_sums_[i].normalized();
  surfel.sigma = 1 / std::sqrt(weights_[i]);
}

int SurfelMap::nearest(const Vec3& point, const Vec3& normal) const {
  const CellKey middle = cell_key(point, cell_);
  int found = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t dz = -1; dz <= 1; ++dz) {
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      for (std::int64_t dx = -1; dx <= 1; ++dx) {
        const Slot& slot = slots_[slot_of(CellKey{middle.x + dx, middle.y + dy, middle.z + dz}.packed())];
        for (int i = slot.first; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
          const SurfaceSample& surfel = surfels_[static_cast<std::size_t>(i)];
          const double squared = (surfel.point - point).squaredNorm();
          if (squared < least && surfel.normal.dot(normal) >= least_cosine) {
            least = squared;
            found = i;
          }
        }
      }
    }
  }
  return found;
}

}  // namespace vantage
