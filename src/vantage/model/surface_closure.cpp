#include "vantage/model/surface_closure.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::size_t most_nodes = std::size_t{1} << 27U;
constexpr int sweeps = 24;  // per level of resolution; each level starts from the coarser one's result

/// Distances on a box of nodes; those that are not known follow from the others.
class Level {
 public:
  Index3 size;
  std::vector<float> value;
  std::vector<std::uint8_t> is_known;

  explicit Level(const Index3& nodes)
      : size(nodes),
        value(static_cast<std::size_t>(nodes.x()) * static_cast<std::size_t>(nodes.y()) *
              static_cast<std::size_t>(nodes.z())),
        is_known(value.size()) {}

  [[nodiscard]] std::size_t at(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(z));
  }

  /// The mean of the known ones of every eight nodes.
  [[nodiscard]] Level halved() const {
    Level coarse((size + Index3::Ones()) / 2);
    parallel_for(static_cast<std::size_t>(coarse.size.z()), [&](std::size_t slice) {
      const int z = static_cast<int>(slice);
      for (int y = 0; y < coarse.size.y(); ++y) {
        for (int x = 0; x < coarse.size.x(); ++x) {
          float sum = 0;
          int count = 0;
          for (int k = 0; k < 8; ++k) {
            const Index3 fine(2 * x + (k & 1), 2 * y + (k >> 1 & 1), 2 * z + (k >> 2));
            if ((fine.array() >= size.array()).any()) continue;
            const std::size_t from = at(fine.x(), fine.y(), fine.z());
            if (is_known[from] == 0) continue;
            sum += value[from];
            ++count;
          }
          const std::size_t to = coarse.at(x, y, z);
          coarse.is_known[to] = count > 0 ? 1 : 0;
          if (count > 0) coarse.value[to] = sum / static_cast<float>(count);
        }
      }
    });
    return coarse;
  }

  void start_from(const Level& coarse) {
    parallel_for(static_cast<std::size_t>(size.z()), [&](std::size_t slice) {
      const int z = static_cast<int>(slice);
      for (int y = 0; y < size.y(); ++y) {
        for (int x = 0; x < size.x(); ++x) {
          const std::size_t here = at(x, y, z);
          if (is_known[here] == 0) value[here] = coarse.value[coarse.at(x / 2, y / 2, z / 2)];
        }
      }
    });
  }

  /// Gauss-Seidel in two colours: the nodes of one are set from those of the other, in any order.
  void relax() {
    for (int color = 0; color < 2; ++color) {
      parallel_for(static_cast<std::size_t>(size.z()), [&](std::size_t slice) {
        const int z = static_cast<int>(slice);
        for (int y = 0; y < size.y(); ++y) {
          for (int x = (y + z + color) & 1; x < size.x(); x += 2) {
            if (is_known[at(x, y, z)] == 0) value[at(x, y, z)] = mean_around(x, y, z);
          }
        }
      });
    }
  }

 private:
  [[nodiscard]] float mean_around(int x, int y, int z) const {
    float sum = 0;
    int count = 0;
    const auto add = [&](bool exists, int u, int v, int w) {
      if (!exists) return;
      sum += value[at(u, v, w)];
      ++count;
    };
    add(x > 0, x - 1, y, z);
    add(x + 1 < size.x(), x + 1, y, z);
    add(y > 0, x, y - 1, z);
    add(y + 1 < size.y(), x, y + 1, z);
    add(z > 0, x, y, z - 1);
    add(z + 1 < size.z(), x, y, z + 1);
    return count > 0 ? sum / static_cast<float>(count) : 0;
  }
};

/// Solves from coarse to fine.
void fill(Level& level) {
  if (level.size.maxCoeff() > 2) {
    Level coarse = level.halved();
    fill(coarse);
    level.start_from(coarse);
  }
  for (int i = 0; i < sweeps; ++i) level.relax();
}

class Closure {
 public:
  Closure(const SurfaceField& field, const VoxelMap& map)
      : field_(field), map_(map), first_(first_node(field, map)), level_(sized(field, map, first_)) {}

  [[nodiscard]] SurfaceField closed() {
    set_known();
    fill(level_);
    const std::vector<std::uint64_t> keys = keys_around_surface();
    std::vector<FieldBlock> blocks(keys.size());
    parallel_for(keys.size(), [&](std::size_t i) { blocks[i] = block_of(unpacked_key(keys[i])); });
    return {field_.cell(), std::move(blocks)};
  }

 private:
  // One node more on every side than the enclosure has: outside.
  static Index3 first_node(const SurfaceField& field, const VoxelMap& map) {
    const Vec3 low = map.grid().box(map.enclosure()).min() / field.cell();
    return low.array().floor().matrix().cast<int>() - Index3::Ones();
  }
  static Index3 sized(const SurfaceField& field, const VoxelMap& map, const Index3& first) {
    const Vec3 high = map.grid().box(map.enclosure()).max() / field.cell();
    const Vec3 size = high.array().ceil().matrix() + Vec3::Constant(2) - first.cast<double>();
    require(size.prod() <= static_cast<double>(most_nodes), "mesh-cell = ", field.cell(),
            " m: closing the surface needs ", size.x(), " x ", size.y(), " x ", size.z(), " cells, more than ",
            most_nodes, "; use longer ones");
    return size.cast<int>();
  }

  void set_known() {
    const auto far = static_cast<float>(2 * field_.cell());
    parallel_for(static_cast<std::size_t>(level_.size.z()), [&](std::size_t slice) {
      const int z = static_cast<int>(slice);
      for (int y = 0; y < level_.size.y(); ++y) {
        for (int x = 0; x < level_.size.x(); ++x) {
          const bool is_border = x == 0 || y == 0 || z == 0 || x + 1 == level_.size.x() || y + 1 == level_.size.y() ||
                                 z + 1 == level_.size.z();
          if (!is_border && !is_empty(first_ + Index3(x, y, z))) continue;
          level_.is_known[level_.at(x, y, z)] = 1;
          level_.value[level_.at(x, y, z)] = far;
        }
      }
    });
    for (const FieldBlock& block : field_.blocks()) set_known(block, far);
  }

  void set_known(const FieldBlock& block, float far) {
    for (std::size_t k = 0; k < SurfaceBlock::size; ++k) {
      const FieldNode& node = block.nodes[k];
      const Index3 at = SurfaceBlock::node(block.key, k) - first_;
      if (node.state == FieldNode::State::unknown || (at.array() < 1).any() ||
          (at.array() + 1 >= level_.size.array()).any()) {
        continue;
      }
      const std::size_t here = level_.at(at.x(), at.y(), at.z());
      level_.is_known[here] = 1;
      level_.value[here] = std::clamp(node.value, -far, far);
    }
  }

  [[nodiscard]] bool is_empty(const Index3& node) const {
    const Index3 voxel = map_.grid().index_of(field_.cell() * node.cast<double>());
    return !map_.enclosure().contains(voxel) || map_.label(voxel) == Label::empty;
  }

  /// The blocks whose cells the zero set passes, and those that the corners of these cells lie in; sorted.
  [[nodiscard]] std::vector<std::uint64_t> keys_around_surface() const {
    const auto slices = static_cast<std::size_t>(level_.size.z() - 1);
    std::vector<std::vector<std::uint64_t>> found(slices);
    parallel_for(slices, [&](std::size_t slice) {
      const int z = static_cast<int>(slice);
      for (int y = 0; y + 1 < level_.size.y(); ++y) {
        for (int x = 0; x + 1 < level_.size.x(); ++x) {
          int inside = 0;
          for (int k = 0; k < 8; ++k)
            inside += level_.value[level_.at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))] < 0 ? 1 : 0;
          if (inside == 0 || inside == 8) continue;
          for (const int step : {0, 1, 2, 3, 4, 5, 6, 7}) {
            const Index3 node = first_ + Index3(x + (step & 1), y + (step >> 1 & 1), z + (step >> 2));
            const std::uint64_t key = packed_key(SurfaceBlock::key_of(node));
            if (found[slice].empty() || found[slice].back() != key) found[slice].push_back(key);
          }
        }
      }
      std::sort(found[slice].begin(), found[slice].end());
      found[slice].erase(std::unique(found[slice].begin(), found[slice].end()), found[slice].end());
    });
    std::vector<std::uint64_t> keys;
    for (const auto& some : found) keys.insert(keys.end(), some.begin(), some.end());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
  }

  [[nodiscard]] FieldBlock block_of(const Index3& key) const {
    FieldBlock block;
    const int number = field_.find(key);
    if (number >= 0) {
      block = field_.blocks()[static_cast<std::size_t>(number)];
    } else {
      block.key = key;
    }
    for (std::size_t k = 0; k < SurfaceBlock::size; ++k) {
      const Index3 at = SurfaceBlock::node(key, k) - first_;
      FieldNode& node = block.nodes[k];
      if ((at.array() < 0).any() || (at.array() >= level_.size.array()).any()) {
        node.state = FieldNode::State::unknown;
        continue;
      }
      const std::size_t here = level_.at(at.x(), at.y(), at.z());
      node.value = level_.value[here];
      const bool is_border = (at.array() < 1).any() || (at.array() + 1 >= level_.size.array()).any();
      if (node.state != FieldNode::State::measured || is_border) node.state = FieldNode::State::filled;
    }
    return block;
  }

  const SurfaceField& field_;
  const VoxelMap& map_;
  Index3 first_;
  Level level_;
};

}  // namespace

SurfaceField closed_field(const SurfaceField& field, const VoxelMap& map) { return Closure(field, map).closed(); }

}  // namespace vantage
