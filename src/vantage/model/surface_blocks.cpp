#include "vantage/model/surface_blocks.hpp"

#include <algorithm>
#include <set>

namespace vantage {
namespace {

// Samples whose normals differ by more than this belong to different surfaces: the sides of a wall, or of an edge.
constexpr float least_cosine_of_a_side = 0.5F;

std::uint16_t one_more(std::uint16_t count) { return count == 65535 ? count : static_cast<std::uint16_t>(count + 1); }

}  // namespace

void SurfaceSide::add(const DistanceSample& sample) {
  const float step = sample.distance - distance;
  weight += sample.weight;
  const float share = sample.weight / weight;
  distance += share * step;
  spread += sample.weight * step * (sample.distance - distance);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto old = static_cast<float>(normal[i]);
    const float mean = old + share * (32767 * sample.normal[static_cast<int>(i)] - old);
    normal[i] = static_cast<std::int16_t>(std::clamp(mean, -32767.0F, 32767.0F));
  }
  frames = one_more(frames);
}

void SurfaceBlock::add(std::size_t node, const DistanceSample& sample) {
  // At the end of the band behind a surface a sample supports nothing; its weight may round to zero.
  if (!(sample.weight > 0) || sample.certainty * SurfaceNode::units_of_support < 1) return;
  SurfaceNode& at = nodes[node];
  at.note_frame(sample, frames_at(node));
  if (at.side.is_seen()) {
    const Vec3f mean = at.side.mean_normal();
    if (mean.dot(sample.normal) < least_cosine_of_a_side * mean.norm()) {
      if (!others) others = std::make_unique<OtherSides>();
      (*others)[node].add(sample);
      return;
    }
  }
  at.side.add(sample);
}

bool SurfaceBlock::is_untouched() const {
  return std::all_of(nodes.begin(), nodes.end(),
                     [](const SurfaceNode& node) { return !node.side.is_seen() && node.looked_through == 0; });
}

SurfaceBlock* SurfaceBlocks::find(const Index3& key) const {
  const auto found = number_of_key_.find(packed_key(key));
  return found == number_of_key_.end() ? nullptr : blocks_[found->second].get();
}

void SurfaceBlocks::make(std::span<const Index3> keys) {
  for (const Index3& key : keys) {
    if (!number_of_key_.try_emplace(packed_key(key), blocks_.size()).second) continue;
    blocks_.push_back(std::make_unique<SurfaceBlock>());
    blocks_.back()->key = key;
  }
}

void SurfaceBlocks::drop_untouched(std::size_t first) {
  std::size_t kept = first;
  for (std::size_t i = first; i < blocks_.size(); ++i) {
    const std::uint64_t key = packed_key(blocks_[i]->key);
    if (blocks_[i]->is_untouched()) {
      number_of_key_.erase(key);
      continue;
    }
    number_of_key_[key] = kept;
    if (kept != i) blocks_[kept] = std::move(blocks_[i]);
    ++kept;
  }
  blocks_.resize(kept);
}

SurfaceBlocks SurfaceBlocks::coarsened() const {
  constexpr int length = SurfaceBlock::side_length;
  SurfaceBlocks coarse(2 * cell_);
  std::set<std::uint64_t> keys;
  const auto half = [](int value) { return value >= 0 ? value / 2 : (value - 1) / 2; };
  for (const auto& block : blocks_) keys.insert(packed_key(block->key.unaryExpr(half)));
  // Every second node of the fine lattice is a node of the coarse one.
  for (const std::uint64_t packed : keys) {
    const Index3 key = unpacked_key(packed);
    coarse.make({&key, 1});
    SurfaceBlock& target = *coarse.blocks_.back();
    for (int z = 0; z < length; ++z) {
      for (int y = 0; y < length; ++y) {
        for (int x = 0; x < length; ++x) {
          const Index3 fine = 2 * (length * key + Index3(x, y, z));
          const Index3 fine_key = fine.unaryExpr([](int value) { return value >= 0 ? value / 8 : (value - 7) / 8; });
          const SurfaceBlock* source = find(fine_key);
          if (source == nullptr) continue;
          const Index3 local = fine - length * fine_key;
          const std::size_t from = SurfaceBlock::index(local.x(), local.y(), local.z());
          const std::size_t to = SurfaceBlock::index(x, y, z);
          target.nodes[to] = source->nodes[from];
          if (!source->others) continue;
          if (!target.others) target.others = std::make_unique<SurfaceBlock::OtherSides>();
          (*target.others)[to] = (*source->others)[from];
        }
      }
    }
  }
  coarse.drop_untouched(0);
  return coarse;
}

Index3 unpacked_key(std::uint64_t packed) {
  constexpr int bits = 21, middle = 1 << 20;
  const auto part = [&](int shift) { return static_cast<int>((packed >> shift) & ((1U << bits) - 1U)) - middle; };
  return {part(0), part(bits), part(2 * bits)};
}

}  // namespace vantage
