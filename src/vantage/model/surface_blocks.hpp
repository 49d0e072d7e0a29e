#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// One frame's word on a lattice point near a surface.
struct DistanceSample {
  float distance = 0;            // from the surface, positive in front of it, metres
  float weight = 0;              // cosine of the incidence over the variance of the depth, 1/m^2
  Vec3f normal = Vec3f::Zero();  // of the surface, world frame
  /// 0 .. 1: how well the frame knows that there is no free space here; it falls off behind the surface, where it only
  /// assumes so.
  float certainty = 1;
  std::uint16_t frame = 0;
};

/// What the frames that saw a surface from one side measured at a lattice point.
struct SurfaceSide {
  float distance = 0;                    // weighted mean of the samples', metres
  float weight = 0;                      // sum of the samples' weights, 1/m^2
  float spread = 0;                      // weighted sum of squared deviations from the mean; weight * m^2
  std::array<std::int16_t, 3> normal{};  // weighted mean, in units of 1/32767
  std::uint16_t frames = 0;

  [[nodiscard]] bool is_seen() const { return weight > 0; }
  [[nodiscard]] Vec3f mean_normal() const {
    constexpr float unit = 1.0F / 32767;
    return {unit * static_cast<float>(normal[0]), unit * static_cast<float>(normal[1]),
            unit * static_cast<float>(normal[2])};
  }
  /// Adds a sample to the running means.
  void add(const DistanceSample& sample);
};

/// A lattice point near a surface.
struct SurfaceNode {
  SurfaceSide side;                             // of the first frame that saw it
  std::uint16_t looked_through = 0;             // frames that saw something well behind it
  std::uint16_t support = 0;                    // sum of the samples' certainties, in units of 1/16
  std::array<std::uint16_t, 2> first_frames{};  // that saw a surface here, where there are as many

  static constexpr int units_of_support = 16;

  /// Notes that a frame supports the node; `supporting` frames did so before.
  void note_frame(const DistanceSample& sample, int supporting) {
    if (supporting < 2) first_frames[static_cast<std::size_t>(supporting)] = sample.frame;
    support =
        static_cast<std::uint16_t>(std::min(65535, support + static_cast<int>(sample.certainty * units_of_support)));
  }
};

/// 8^3 nodes, x fastest. Node (x, y, z) of block k lies at cell * (8 k + (x, y, z)) in the world.
struct SurfaceBlock {
  static constexpr int side_length = 8;
  static constexpr std::size_t size = 512;
  using OtherSides = std::array<SurfaceSide, size>;

  Index3 key = Index3::Zero();
  std::array<SurfaceNode, size> nodes{};
  std::unique_ptr<OtherSides> others;  // of walls thinner than what the samples reach over, and of sharp edges

  [[nodiscard]] static std::size_t index(int x, int y, int z) {
    return static_cast<std::size_t>(x + side_length * (y + side_length * z));
  }
  /// Where node `index` of the block with this key lies on the lattice.
  [[nodiscard]] static Index3 node(const Index3& key, std::size_t index) {
    const int i = static_cast<int>(index);
    return side_length * key + Index3(i & 7, i >> 3 & 7, i >> 6);
  }
  /// The block that a node of the lattice lies in.
  [[nodiscard]] static Index3 key_of(const Index3& node) {
    return node.unaryExpr([](int value) { return value >> 3; });
  }
  /// Frames that saw a surface at a node.
  [[nodiscard]] int frames_at(std::size_t node) const {
    return nodes[node].side.frames + (others ? (*others)[node].frames : 0);
  }
  void add(std::size_t node, const DistanceSample& sample);
  [[nodiscard]] bool is_untouched() const;
};

/// The blocks that surfaces pass through, found by their place.
class SurfaceBlocks {
 public:
  explicit SurfaceBlocks(double cell) : cell_(cell) {}

  [[nodiscard]] double cell() const { return cell_; }
  [[nodiscard]] double block_length() const { return cell_ * SurfaceBlock::side_length; }
  /// In the order in which they were made, which depends on the scans alone.
  [[nodiscard]] std::span<const std::unique_ptr<SurfaceBlock>> all() const { return blocks_; }
  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  /// nullptr where there is none.
  [[nodiscard]] SurfaceBlock* find(const Index3& key) const;
  /// Makes the blocks of these keys that are not there yet.
  void make(std::span<const Index3> keys);
  /// Drops the blocks from number `first` on that nothing has been written to.
  void drop_untouched(std::size_t first);
  /// The same surface on cells twice as long.
  [[nodiscard]] SurfaceBlocks coarsened() const;

 private:
  double cell_;
  std::vector<std::unique_ptr<SurfaceBlock>> blocks_;
  std::unordered_map<std::uint64_t, std::size_t> number_of_key_;
};

/// The key of the block that a point lies in, as one number; keys sort along z, y, x.
[[nodiscard]] inline std::uint64_t packed_key(const Index3& key) {
  constexpr int bits = 21, middle = 1 << 20;
  const auto part = [](int value) { return static_cast<std::uint64_t>(value + middle) & ((1U << bits) - 1U); };
  return part(key.z()) << (2 * bits) | part(key.y()) << bits | part(key.x());
}
[[nodiscard]] Index3 unpacked_key(std::uint64_t packed);

}  // namespace vantage
