#include "vantage/model/surface_field.hpp"

#include <algorithm>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

// A side of a surface that the samples on the other one outweigh this far is what noise made of that one.
constexpr float least_share_of_a_side = 0.15F;
// Beyond 45 degrees neighbours are not of the same surface.
constexpr float least_cosine_of_neighbours = 0.7F;

/// Standard error of the mean distance: by the samples' own variances, or by their scatter where that is larger.
float sigma_of(const SurfaceSide& side) {
  const float scatter = side.frames > 1 ? side.spread / static_cast<float>(side.frames - 1) : 1;
  return std::sqrt(std::max(1.0F, scatter) / side.weight);
}

FieldNode weigh(const SurfaceNode& node, const SurfaceSide* other, float outside) {
  FieldNode result;
  const SurfaceSide* side = &node.side;
  if (other != nullptr && other->is_seen()) {
    const float both = side->weight + other->weight;
    const bool keep_first = side->weight >= least_share_of_a_side * both;
    const bool keep_other = other->weight >= least_share_of_a_side * both;
    // What is in front of either side of a wall, or of a convex edge, is outside.
    if (keep_other && (!keep_first || other->distance > side->distance)) {
      side = other;
      result.is_of_other_side = true;
    }
  }
  const bool was_looked_through = SurfaceNode::units_of_support * node.looked_through > node.support;
  if (!side->is_seen() || (side->distance < 0 && was_looked_through)) {
    if (node.looked_through == 0) return result;
    result.state = FieldNode::State::free;
    result.value = outside;
    return result;
  }
  result.state = FieldNode::State::measured;
  result.value = side->distance;
  result.sigma = sigma_of(*side);
  return result;
}

/// The nodes of a block and those one step around it.
class NodesAround {
 public:
  NodesAround(const SurfaceField& field, std::size_t block) {
    for (int k = 0; k < 27; ++k) {
      const int number = field.find(field.blocks()[block].key + Index3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
      blocks_[static_cast<std::size_t>(k)] = number < 0 ? nullptr : &field.blocks()[static_cast<std::size_t>(number)];
    }
  }
  struct Place {
    const FieldBlock* block = nullptr;
    std::size_t node = 0;
  };
  /// Coordinates -1 .. 8 from the block's first node.
  [[nodiscard]] Place at(int x, int y, int z) const {
    const int k = ((x + 8) >> 3) + 3 * ((y + 8) >> 3) + 9 * ((z + 8) >> 3);
    return {blocks_[static_cast<std::size_t>(k)], SurfaceBlock::index(x & 7, y & 7, z & 7)};
  }

 private:
  std::array<const FieldBlock*, 27> blocks_{};
};

/// The distance at a node by the planes of its neighbours too, as far as they are of the same surface: their normals
/// agree, and their planes lie where the noise allows.
float smoothed(const NodesAround& around, const Index3& at, float cell) {
  const NodesAround::Place here = around.at(at.x(), at.y(), at.z());
  const FieldNode& node = here.block->nodes[here.node];
  const Vec3f normal = here.block->normal(here.node);
  float weights = 1 / (node.sigma * node.sigma), sum = 0;
  for (int k = 0; k < 27; ++k) {
    const Index3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const auto [block, index] = around.at(at.x() + step.x(), at.y() + step.y(), at.z() + step.z());
    if (k == 13 || block == nullptr || block->nodes[index].state != FieldNode::State::measured) continue;
    const FieldNode& other = block->nodes[index];
    const Vec3f its_normal = block->normal(index);
    const float cosine = its_normal.dot(normal) / (its_normal.norm() * normal.norm());
    if (!(cosine > least_cosine_of_neighbours)) continue;
    const float difference = other.value - cell * its_normal.normalized().dot(step.cast<float>()) - node.value;
    const float variance = node.sigma * node.sigma + other.sigma * other.sigma;
    const float tolerance = 0.05F * cell;
    if (difference * difference > 9 * variance + tolerance * tolerance) continue;
    const float closeness = std::exp(-0.5F * static_cast<float>(step.squaredNorm()));
    const float weight = closeness * (cosine - least_cosine_of_neighbours) / (1 - least_cosine_of_neighbours) /
                         (other.sigma * other.sigma);
    weights += weight;
    sum += weight * difference;
  }
  return node.value + sum / weights;
}

}  // namespace

SurfaceField::SurfaceField(const SurfaceBlocks& blocks) : cell_(blocks.cell()), blocks_(blocks.size()) {
  std::vector<const SurfaceBlock*> sorted;
  for (const auto& block : blocks.all()) sorted.push_back(block.get());
  std::sort(sorted.begin(), sorted.end(),
            [](const SurfaceBlock* a, const SurfaceBlock* b) { return packed_key(a->key) < packed_key(b->key); });
  parallel_for(sorted.size(), [&](std::size_t i) {
    const SurfaceBlock& source = *sorted[i];
    blocks_[i].key = source.key;
    blocks_[i].source = &source;
    for (std::size_t node = 0; node < SurfaceBlock::size; ++node) {
      blocks_[i].nodes[node] =
          weigh(source.nodes[node], source.others ? &(*source.others)[node] : nullptr, static_cast<float>(2 * cell_));
    }
  });
  index_blocks();
  smooth();
}

void SurfaceField::smooth() {
  std::vector<std::array<float, SurfaceBlock::size>> values(blocks_.size());
  const auto cell = static_cast<float>(cell_);
  parallel_for(blocks_.size(), [&](std::size_t i) {
    const NodesAround around(*this, i);
    for (std::size_t k = 0; k < SurfaceBlock::size; ++k) {
      const FieldNode& node = blocks_[i].nodes[k];
      const int n = static_cast<int>(k);
      const bool is_near = node.state == FieldNode::State::measured && std::abs(node.value) < 2 * cell;
      values[i][k] = is_near ? smoothed(around, {n & 7, n >> 3 & 7, n >> 6}, cell) : node.value;
    }
  });
  parallel_for(blocks_.size(), [&](std::size_t i) {
    for (std::size_t k = 0; k < SurfaceBlock::size; ++k) blocks_[i].nodes[k].value = values[i][k];
  });
}

int SurfaceField::find(const Index3& key) const {
  const auto found = number_of_key_.find(packed_key(key));
  return found == number_of_key_.end() ? -1 : found->second;
}

void SurfaceField::index_blocks() {
  number_of_key_.clear();
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    number_of_key_.emplace(packed_key(blocks_[i].key), static_cast<int>(i));
}

}  // namespace vantage
