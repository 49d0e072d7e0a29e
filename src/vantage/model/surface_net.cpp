#include "vantage/model/surface_net.hpp"

#include <algorithm>
#include <map>

#include "vantage/core/parallel.hpp"
#include "vantage/model/surface_patches.hpp"

namespace vantage {
namespace {

constexpr int length = SurfaceBlock::side_length;
constexpr float border = 0.01F;  // vertices stay this far inside their cell, in cells: no two meet
// Pulls a vertex to the middle of its sheet's crossings, against planes that only noise turns: the square of a normal's
// error of about 0.15, for each crossing.
constexpr float pull = 0.025F;

// Distances to a surface differ by a cell at most between neighbouring nodes; rounding of the surface adds a little.
constexpr float steepest_distance = 1.5F;

/// The corners of a block's cells: its own nodes and those next to it.
class NodesOfBlock {
 public:
  NodesOfBlock(const SurfaceField& field, std::size_t block) {
    for (int k = 0; k < 8; ++k) {
      const int number = field.find(field.blocks()[block].key + Index3(k & 1, k >> 1 & 1, k >> 2 & 1));
      blocks_[static_cast<std::size_t>(k)] = number < 0 ? nullptr : &field.blocks()[static_cast<std::size_t>(number)];
    }
  }
  struct Place {
    const FieldBlock* block;
    std::size_t node;
    [[nodiscard]] const FieldNode& operator*() const { return block->nodes[node]; }
  };
  /// Coordinates 0 .. 8 from the block's first node. A block of nullptr where there is none.
  [[nodiscard]] Place at(int x, int y, int z) const {
    const auto k = static_cast<std::size_t>((x >> 3) | (y >> 3) << 1 | (z >> 3) << 2);
    return {blocks_[k], SurfaceBlock::index(x & 7, y & 7, z & 7)};
  }

 private:
  std::array<const FieldBlock*, 8> blocks_{};
};

struct Crossing {
  Vec3f place;   // in the cell, 0 .. 1
  Vec3f normal;  // zero where unknown
  float sigma;
  bool is_steep;  // the distances at its ends are farther apart than one surface puts them: nobody saw it here
};

using Corners = std::array<NodesOfBlock::Place, 8>;

Crossing crossing(const Corners& corners, std::size_t edge, float cell) {
  const CubeEdge ends = cube_edge(edge);
  const auto &from = corners[ends.from], &to = corners[ends.to];
  const float share = (*from).value / ((*from).value - (*to).value);
  Vec3f place(static_cast<float>(ends.from & 1U), static_cast<float>(ends.from >> 1U & 1U),
              static_cast<float>(ends.from >> 2U & 1U));
  place[static_cast<int>(edge / 4)] = share;
  const Vec3f a = from.block->normal(from.node), b = to.block->normal(to.node);
  Vec3f normal = (1 - share) * a + share * b;
  if (a.dot(b) < 0.5F * a.norm() * b.norm()) normal = share < 0.5F ? a : b;  // of two surfaces: the nearer one's
  const float norm = normal.norm();
  if (norm > 0) normal /= norm;
  const float apart = std::abs((*from).value - (*to).value);
  const bool is_steep = apart > steepest_distance * cell + 2 * std::hypot((*from).sigma, (*to).sigma);
  return {place, normal, (1 - share) * (*from).sigma + share * (*to).sigma, is_steep};
}

/// The point that lies best on the planes of the crossings, in the cell.
Vec3f best_point(std::span<const Crossing> crossings) {
  Vec3f mean = Vec3f::Zero();
  for (const Crossing& each : crossings) mean += each.place;
  mean /= static_cast<float>(crossings.size());
  Eigen::Matrix3f sum = static_cast<float>(crossings.size()) * pull * Eigen::Matrix3f::Identity();
  Vec3f right = Vec3f::Zero();
  for (const Crossing& each : crossings) {
    sum += each.normal * each.normal.transpose();
    right += each.normal * each.normal.dot(each.place - mean);
  }
  const Vec3f point = mean + sum.inverse() * right;
  return point.cwiseMax(border).cwiseMin(1 - border);
}

/// The cells of one block: those that have the surface in them, and their vertices.
struct BlockCells {
  std::array<std::int32_t, SurfaceBlock::size> first{};   // vertex of each cell; -1: none
  std::array<std::uint8_t, SurfaceBlock::size> inside{};  // which corners are
  std::vector<NetVertex> vertices;
};

class Net {
 public:
  Net(const SurfaceField& field, const Box3& box) : field_(field), cells_(field.blocks().size()) {
    first_cell_ = (box.min() / field.cell() - Vec3::Constant(1e-6)).array().ceil().matrix().cast<int>();
    end_cell_ = (box.max() / field.cell() + Vec3::Constant(1e-6)).array().floor().matrix().cast<int>();
    parallel_for(cells_.size(), [&](std::size_t i) { find_vertices(i); });
    std::int32_t count = 0;
    for (BlockCells& cells : cells_) {
      for (std::int32_t& first : cells.first) first += first >= 0 ? count : 0;
      count += static_cast<std::int32_t>(cells.vertices.size());
      net_.vertices.insert(net_.vertices.end(), cells.vertices.begin(), cells.vertices.end());
      cells.vertices.clear();
    }
    first_on_face_ = count;
    for (std::size_t i = 0; i < cells_.size(); ++i) add_quads(i);
  }

  [[nodiscard]] SurfaceNet take() && { return std::move(net_); }

 private:
  struct Cell {
    const BlockCells* cells = nullptr;
    std::size_t index = 0;

    [[nodiscard]] bool has_surface() const { return cells != nullptr && cells->first[index] >= 0; }
    [[nodiscard]] std::int8_t patch(std::size_t edge) const {
      return cube_patches().patch_of_edge[cells->inside[index]][edge];
    }
    [[nodiscard]] int vertex(std::size_t edge) const { return cells->first[index] + patch(edge); }
  };

  void find_vertices(std::size_t block) {
    BlockCells& cells = cells_[block];
    cells.first.fill(-1);
    const NodesOfBlock nodes(field_, block);
    const Index3 first_node = length * field_.blocks()[block].key;
    for (int z = 0; z < length; ++z) {
      for (int y = 0; y < length; ++y) {
        for (int x = 0; x < length; ++x) {
          const Index3 cell = first_node + Index3(x, y, z);
          if ((cell.array() < first_cell_.array()).any() || (cell.array() >= end_cell_.array()).any()) continue;
          find_vertices(nodes, Index3(x, y, z), cell, cells);
        }
      }
    }
  }

  void find_vertices(const NodesOfBlock& nodes, const Index3& local, const Index3& cell, BlockCells& cells) const {
    Corners corners{};
    unsigned inside = 0;
    for (int k = 0; k < 8; ++k) {
      const auto place = nodes.at(local.x() + (k & 1), local.y() + (k >> 1 & 1), local.z() + (k >> 2 & 1));
      if (place.block == nullptr || !(*place).has_surface()) return;
      corners[static_cast<std::size_t>(k)] = place;
      inside |= ((*place).value < 0 ? 1U : 0U) << static_cast<unsigned>(k);
    }
    if (inside == 0 || inside == 255) return;
    const std::size_t index = SurfaceBlock::index(local.x(), local.y(), local.z());
    cells.first[index] = static_cast<std::int32_t>(cells.vertices.size());
    cells.inside[index] = static_cast<std::uint8_t>(inside);
    for (int patch = 0; patch < cube_patches().count[inside]; ++patch)
      cells.vertices.push_back(vertex(corners, inside, patch, cell));
  }

  [[nodiscard]] NetVertex vertex(const Corners& corners, unsigned inside, int patch, const Index3& cell) const {
    std::array<Crossing, 12> crossings{};
    std::size_t count = 0;
    float sigma = 0;
    bool is_steep = false;
    for (std::size_t edge = 0; edge < 12; ++edge) {
      if (cube_patches().patch_of_edge[inside][edge] != patch) continue;
      crossings[count] = crossing(corners, edge, static_cast<float>(field_.cell()));
      is_steep = is_steep || crossings[count].is_steep;
      sigma += crossings[count++].sigma;
    }
    NetVertex vertex;
    const Vec3 in_cell = best_point({crossings.data(), count}).cast<double>();
    vertex.position = (field_.cell() * (cell.cast<double>() + in_cell)).cast<float>();
    vertex.sigma = sigma / static_cast<float>(count);
    vertex.is_seen = !is_steep && std::all_of(corners.begin(), corners.end(), [](const auto& corner) {
      return (*corner).state == FieldNode::State::measured;
    });
    for (const auto& corner : corners) {
      if (corner.block->source == nullptr) continue;
      const int frames = std::min(3, corner.block->source->frames_at(corner.node));
      if (frames <= vertex.frames) continue;
      vertex.frames = static_cast<std::uint8_t>(frames);
      vertex.first_frames = corner.block->source->nodes[corner.node].first_frames;
    }
    return vertex;
  }

  [[nodiscard]] Cell cell_at(const Index3& index) const {
    const Index3 key = index.unaryExpr([](int value) { return value >> 3; });
    const int block = field_.find(key);
    if (block < 0) return {};
    const Index3 local = index - length * key;
    return {&cells_[static_cast<std::size_t>(block)], SurfaceBlock::index(local.x(), local.y(), local.z())};
  }

  void add_quads(std::size_t block) {
    const BlockCells& cells = cells_[block];
    const Index3 first_node = length * field_.blocks()[block].key;
    for (int z = 0; z < length; ++z) {
      for (int y = 0; y < length; ++y) {
        for (int x = 0; x < length; ++x) {
          const std::size_t index = SurfaceBlock::index(x, y, z);
          if (cells.first[index] < 0) continue;
          for (int axis = 0; axis < 3; ++axis) {
            const unsigned ends = cells.inside[index] & (1U | 1U << (1U << static_cast<unsigned>(axis)));
            if (ends == 0 || ends == (1U | 1U << (1U << static_cast<unsigned>(axis)))) continue;
            add_quad(first_node + Index3(x, y, z), axis, (ends & 1U) != 0);
          }
        }
      }
    }
  }

  /// The polygon through the four cells around the edge from a node along an axis; `leaves`: the node is inside.
  void add_quad(const Index3& node, int axis, bool leaves) {
    const auto a = static_cast<std::size_t>(axis);
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    // Counter-clockwise seen from the axis' far end; the edge's place in each cell.
    constexpr std::array<std::array<int, 2>, 4> around{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
    std::array<Cell, 4> cells;
    for (std::size_t k = 0; k < 4; ++k) {
      Index3 index = node;
      index[right] -= around[k][0];
      index[up] -= around[k][1];
      cells[k] = cell_at(index);
      if (!cells[k].has_surface()) return;
    }
    const auto edge = [&](std::size_t k) { return 4 * a + static_cast<std::size_t>(around[k][0] + 2 * around[k][1]); };
    std::vector<int> polygon;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      polygon.push_back(cells[k].vertex(edge(k)));
      // Two sheets that meet in the face between two cells and join on both sides of it would share an edge: there
      // each gets a vertex of its own on the face.
      const bool along_right = around[k][0] != around[next][0];
      const std::size_t flip = along_right ? 2 : 1;  // to the edge across the face
      const std::size_t here = edge(k), there = edge(next);
      const bool joins_here = cells[k].patch(here) == cells[k].patch(here ^ flip);
      const bool joins_there = cells[next].patch(there) == cells[next].patch(there ^ flip);
      if (joins_here && joins_there && is_ambiguous(cells[k], here, flip)) {
        Index3 inner = node;
        if (!leaves) ++inner[axis];
        polygon.push_back(vertex_on_face(cells[k].vertex(here), cells[next].vertex(there), inner));
      }
    }
    if (!leaves) std::reverse(polygon.begin(), polygon.end());
    add_polygon(polygon);
  }

  /// Inside corners lie across from each other on the face of the edge and the one across.
  [[nodiscard]] static bool is_ambiguous(const Cell& cell, std::size_t edge, std::size_t flip) {
    const CubeEdge one = cube_edge(edge), other = cube_edge(edge ^ flip);
    const auto is_inside = [&](std::size_t corner) { return (cell.cells->inside[cell.index] >> corner & 1U) != 0; };
    return is_inside(one.from) != is_inside(one.to) && is_inside(other.from) != is_inside(other.to) &&
           is_inside(one.from) != is_inside(other.from);
  }

  /// The vertex of the sheet around this inside node on the face between the cells of two vertices.
  int vertex_on_face(int a, int b, const Index3& inner) {
    const std::array<int, 5> key{std::min(a, b), std::max(a, b), inner.x(), inner.y(), inner.z()};
    const auto [entry, is_new] = on_face_.try_emplace(key, static_cast<int>(net_.vertices.size()));
    if (is_new) {
      const NetVertex& from = net_.vertices[static_cast<std::size_t>(a)];
      const NetVertex& to = net_.vertices[static_cast<std::size_t>(b)];
      NetVertex vertex = from;
      const Vec3f node = (field_.cell() * inner.cast<double>()).cast<float>();
      vertex.position = 0.4F * (from.position + to.position) + 0.2F * node;
      vertex.is_seen = from.is_seen && to.is_seen;
      net_.vertices.push_back(vertex);
    }
    return entry->second;
  }

  void add_polygon(const std::vector<int>& polygon) {
    const auto at = [&](std::size_t k) -> const Vec3f& {
      return net_.vertices[static_cast<std::size_t>(polygon[k])].position;
    };
    const std::size_t count = polygon.size();
    std::size_t from = count == 4 && (at(0) - at(2)).squaredNorm() > (at(1) - at(3)).squaredNorm() ? 1 : 0;
    // A vertex on a face has no edge to its cells but those of the polygon, so that no two polygons cut alike.
    for (std::size_t k = 0; k < count; ++k) {
      if (polygon[k] >= first_on_face_) from = k;
    }
    for (std::size_t k = 1; k + 1 < count; ++k) {
      net_.triangles.emplace_back(polygon[from], polygon[(from + k) % count], polygon[(from + k + 1) % count]);
    }
  }

  const SurfaceField& field_;
  std::vector<BlockCells> cells_;
  Index3 first_cell_, end_cell_;
  std::map<std::array<int, 5>, int> on_face_;
  int first_on_face_ = 0;  // vertices from this one on lie on faces between cells
  SurfaceNet net_;
};

}  // namespace

SurfaceNet surface_net(const SurfaceField& field, const Box3& box) { return Net(field, box).take(); }

}  // namespace vantage
