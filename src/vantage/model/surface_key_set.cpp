#include "vantage/model/surface_key_set.hpp"

#include <utility>

namespace vantage {

void KeySet::insert(std::uint64_t key) {
  if (key == last_) return;
  last_ = key;
  if (2 * (count_ + 1) > slots_.size()) grow();
  add(key);
}

void KeySet::insert_around(const Vec3f& place_in_blocks, float margin) {
  std::array<std::array<int, 2>, 3> along{};
  std::array<std::size_t, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float place = place_in_blocks[static_cast<int>(i)];
    const float floor = std::floor(place);
    const float within = place - floor;
    along[i][0] = static_cast<int>(floor);
    counts[i] = 1;
    if (within < margin) along[i][counts[i]++] = along[i][0] - 1;
    if (within > 1 - margin) along[i][counts[i]++] = along[i][0] + 1;
  }
  for (std::size_t z = 0; z < counts[2]; ++z) {
    for (std::size_t y = 0; y < counts[1]; ++y) {
      for (std::size_t x = 0; x < counts[0]; ++x) insert(packed_key({along[0][x], along[1][y], along[2][z]}));
    }
  }
}

std::vector<std::uint64_t> KeySet::keys() const {
  std::vector<std::uint64_t> keys;
  for (const std::uint64_t slot : slots_) {
    if (slot != free_slot) keys.push_back(slot);
  }
  return keys;
}

void KeySet::add(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ULL) >> 32U) & mask;
  while (slots_[at] != free_slot) {
    if (slots_[at] == key) return;
    at = (at + 1) & mask;
  }
  slots_[at] = key;
  ++count_;
}

void KeySet::grow() {
  const std::vector<std::uint64_t> old =
      std::exchange(slots_, std::vector<std::uint64_t>(2 * slots_.size(), free_slot));
  count_ = 0;
  for (const std::uint64_t slot : old) {
    if (slot != free_slot) add(slot);
  }
}

}  // namespace vantage
