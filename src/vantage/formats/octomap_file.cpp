#include "vantage/formats/octomap_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

constexpr int depth = 16;                        // levels of every OctoMap
constexpr int key_of_origin = 1 << (depth - 1);  // cell 0 on each axis starts at the origin
constexpr double lattice_tolerance = 1e-6;       // of a cell

/// What a node of the tree is; the numbers are its two bits in the file.
enum class Node : unsigned { unknown = 0, free = 1, occupied = 2, inner = 3 };

Node leaf(Label label) {
  if (label == Label::occupied) return Node::occupied;
  return label == Label::empty ? Node::free : Node::unknown;
}

/// Writes the tree from the root down, as OctoMap reads it.
class TreeWriter {
 public:
  TreeWriter(const VoxelMap& map, const OctomapLattice& lattice) : map_(map), cells_(lattice.cells_per_voxel) {
    const Vec3 first = (map.grid().corner(map.enclosure().min) + lattice.shift) / lattice.resolution;
    const Vec3 rounded = first.array().round();
    const Vec3 last = rounded + (cells_ * map.enclosure().size()).cast<double>();
    require(rounded.minCoeff() >= -key_of_origin && last.maxCoeff() <= key_of_origin,
            "the enclosure reaches from cell ", rounded.transpose(), " to ", last.transpose(),
            " of the OctoMap, which has only those from ", -key_of_origin, " to ", key_of_origin);
    first_key_ = rounded.cast<int>() + Index3::Constant(key_of_origin);
    end_key_ = first_key_ + cells_ * map.enclosure().size();
  }

  /// Appends what is below the node of 2^level cells at `key` and returns what the node itself is.
  Node write(const Index3& key, int level) {
    if (level == 0) return leaf(map_.label(map_.enclosure().min + (key - first_key_) / cells_));
    const std::size_t start = tree_.size();
    const std::size_t nodes_before = nodes_;
    tree_.append(2, '\0');
    std::array<Node, 8> children{};
    bool all_same = true;
    unsigned bits = 0;
    for (unsigned child = 0; child < 8; ++child) {
      const Index3 offset(child & 1U, child >> 1U & 1U, child >> 2U & 1U);
      const Index3 child_key = key + (1 << (level - 1)) * offset;
      children[child] = touches(child_key, level - 1) ? write(child_key, level - 1) : Node::unknown;
      all_same = all_same && children[child] == children[0];
      bits |= static_cast<unsigned>(children[child]) << (2 * child);
      nodes_ += children[child] != Node::unknown ? 1 : 0;
    }
    if (all_same && children[0] != Node::inner) {
      // Eight equal leaves are one larger leaf.
      tree_.resize(start);
      nodes_ = nodes_before;
      return children[0];
    }
    tree_[start] = static_cast<char>(bits & 0xffU);
    tree_[start + 1] = static_cast<char>(bits >> 8U);
    return Node::inner;
  }

  [[nodiscard]] const std::string& tree() const { return tree_; }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }

 private:
  [[nodiscard]] bool touches(const Index3& key, int level) const {
    const Index3 end = key + Index3::Constant(1 << level);
    // Blocks that are partly outside are walked into, single cells outside are unknown.
    return (key.array() < end_key_.array()).all() && (end.array() > first_key_.array()).all();
  }

  const VoxelMap& map_;
  int cells_;
  Index3 first_key_, end_key_;
  std::string tree_;
  std::size_t nodes_ = 0;
};

}  // namespace

OctomapLattice octomap_lattice(const Grid& grid) {
  OctomapLattice lattice;
  const auto offset = [&](double resolution) {
    const Vec3 corner = grid.min / resolution;
    return Vec3(corner.array().round().matrix() - corner);
  };
  const auto fits = [&](double resolution) { return offset(resolution).cwiseAbs().maxCoeff() < lattice_tolerance; };
  lattice.resolution = grid.length;
  if (fits(grid.length)) return lattice;
  if (fits(0.5 * grid.length)) {
    lattice.cells_per_voxel = 2;
    lattice.resolution = 0.5 * grid.length;
    return lattice;
  }
  lattice.shift = grid.length * offset(grid.length);
  return lattice;
}

std::string octomap_bytes(const VoxelMap& map) {
  const OctomapLattice lattice = octomap_lattice(map.grid());
  TreeWriter writer(map, lattice);
  const Node root = writer.write(Index3::Zero(), depth);
  // OctoMap has no file for a root without children; a map that knows nothing is an empty tree.
  const std::size_t nodes = root == Node::inner ? writer.nodes() + 1 : 0;
  std::string bytes = "# Octomap OcTree binary file\n";
  if (!lattice.shift.isZero(0)) {
    bytes += fmt::format("# moved by ({}, {}, {}) m onto the cells of this file\n", lattice.shift.x(),
                         lattice.shift.y(), lattice.shift.z());
  }
  bytes += fmt::format("id OcTree\nsize {}\nres {}\ndata\n", nodes, lattice.resolution);
  return root == Node::inner ? bytes + writer.tree() : bytes;
}

void write_octomap(const VoxelMap& map, const std::filesystem::path& path) {
  write_file_atomically(path, octomap_bytes(map));
}

}  // namespace vantage
