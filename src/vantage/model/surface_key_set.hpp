#pragma once

#include "vantage/model/surface_blocks.hpp"

namespace vantage {

/// A set of block keys for insertions in bursts of the same few.
class KeySet {
 public:
  /// `slots`: a power of two; it grows.
  explicit KeySet(std::size_t slots = 1024) : slots_(slots, free_slot) {}
  void insert(std::uint64_t key);
  /// Adds the block of a place (in units of blocks) and those next to it that are nearer than `margin` blocks.
  void insert_around(const Vec3f& place_in_blocks, float margin);
  /// In no particular order.
  [[nodiscard]] std::vector<std::uint64_t> keys() const;

 private:
  static constexpr std::uint64_t free_slot = ~std::uint64_t{0};

  void add(std::uint64_t key);
  void grow();

  std::vector<std::uint64_t> slots_;
  std::size_t count_ = 0;
  std::uint64_t last_ = free_slot;
};

}  // namespace vantage
