#pragma once

#include "vantage/model/surface_blocks.hpp"

namespace vantage {

/// The signed distance of the surface at a lattice point, and whose word that is.
struct FieldNode {
  enum class State : std::uint8_t {
    unknown,   // nobody saw it
    free,      // frames looked through it, none saw a surface near it or too few to be believed
    measured,  // near a measured surface
    filled,    // closed where nobody saw anything
  };
  float value = 0;  // metres, positive outside; of `free` nodes: well outside
  float sigma = 0;  // of the value, metres; `measured` only
  State state = State::unknown;
  bool is_of_other_side = false;  // the normal is that of SurfaceBlock::others

  [[nodiscard]] bool has_surface() const { return state == State::measured || state == State::filled; }
};

struct FieldBlock {
  Index3 key = Index3::Zero();
  const SurfaceBlock* source = nullptr;  // normals, frames; nullptr where nobody saw anything
  std::array<FieldNode, SurfaceBlock::size> nodes{};

  /// Of the surface near a measured node.
  [[nodiscard]] Vec3f normal(std::size_t node) const {
    if (source == nullptr) return Vec3f::Zero();
    return nodes[node].is_of_other_side ? (*source->others)[node].mean_normal()
                                        : source->nodes[node].side.mean_normal();
  }
};

/// What the blocks of a surface say, weighed node by node. Keeps pointers to the blocks.
class SurfaceField {
 public:
  explicit SurfaceField(const SurfaceBlocks& blocks);
  /// Of blocks sorted by key.
  SurfaceField(double cell, std::vector<FieldBlock> blocks) : cell_(cell), blocks_(std::move(blocks)) {
    index_blocks();
  }

  [[nodiscard]] double cell() const { return cell_; }
  [[nodiscard]] std::span<const FieldBlock> blocks() const { return blocks_; }
  /// -1 where there is no block with this key.
  [[nodiscard]] int find(const Index3& key) const;

 private:
  void index_blocks();
  /// Takes noise out of the distances near the surface.
  void smooth();

  double cell_;
  std::vector<FieldBlock> blocks_;  // sorted by key
  std::unordered_map<std::uint64_t, int> number_of_key_;
};

}  // namespace vantage
