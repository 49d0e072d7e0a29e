#include "vantage/model/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <unordered_map>

namespace vantage {
namespace {

/// Sets that grow together, each named by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }

  [[nodiscard]] int root(int member) {
    while (parent(member) != member) member = parent(member) = parent(parent(member));
    return member;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  [[nodiscard]] int& parent(int member) { return parent_[static_cast<std::size_t>(member)]; }
  std::vector<int> parent_;
};

/// Up to three different frames.
class FewFrames {
 public:
  void add(const NetVertex& vertex) {
    most_at_once_ = std::max(most_at_once_, static_cast<int>(vertex.frames));
    for (int i = 0; i < std::min<int>(2, vertex.frames); ++i) add(vertex.first_frames[static_cast<std::size_t>(i)]);
  }
  [[nodiscard]] int count() const { return std::max(most_at_once_, count_); }

 private:
  void add(std::uint16_t frame) {
    const auto end = frames_.begin() + count_;
    if (count_ < 3 && std::find(frames_.begin(), end, frame) == end)
      frames_[static_cast<std::size_t>(count_++)] = frame;
  }
  std::array<std::uint16_t, 3> frames_{};
  int count_ = 0, most_at_once_ = 0;
};

/// What the triangles of one part come to.
struct Part {
  FewFrames frames;
  double six_volumes = 0;  // positive where they face outwards
};

/// The triangles of the parts that `keep` holds for.
template <class Keep>
std::vector<Index3> parts_of(const SurfaceNet& net, const std::vector<Index3>& triangles, const Keep& keep) {
  DisjointSets sets(net.vertices.size());
  for (const Index3& triangle : triangles) {
    sets.join(triangle[0], triangle[1]);
    sets.join(triangle[0], triangle[2]);
  }
  std::unordered_map<int, Part> parts;
  for (std::size_t i = 0; i < net.vertices.size(); ++i)
    parts[sets.root(static_cast<int>(i))].frames.add(net.vertices[i]);
  const auto corner = [&](const Index3& triangle, int k) {
    return Vec3(net.vertices[static_cast<std::size_t>(triangle[k])].position.cast<double>());
  };
  for (const Index3& triangle : triangles) {
    parts.at(sets.root(triangle[0])).six_volumes +=
        corner(triangle, 0).dot(corner(triangle, 1).cross(corner(triangle, 2)));
  }
  std::vector<Index3> kept;
  for (const Index3& triangle : triangles) {
    if (keep(parts.at(sets.root(triangle[0])))) kept.push_back(triangle);
  }
  return kept;
}

/// For each corner of each triangle, the fan that it belongs to: corners of a vertex whose triangles share an edge
/// there.
DisjointSets fans_of(const std::vector<Index3>& triangles) {
  DisjointSets fans(3 * triangles.size());
  std::unordered_map<std::uint64_t, int> corner_of_edge;  // the corner that a directed edge starts from
  corner_of_edge.reserve(3 * triangles.size());
  const auto key = [](int from, int to) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32U | static_cast<std::uint32_t>(to);
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k)
      corner_of_edge.emplace(key(triangles[t][k], triangles[t][(k + 1) % 3]), static_cast<int>(3 * t) + k);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const auto opposite = corner_of_edge.find(key(triangles[t][next], triangles[t][k]));
      if (opposite == corner_of_edge.end()) continue;
      const int there = opposite->second, first = there / 3 * 3;  // the corner at the end of this edge
      fans.join(static_cast<int>(3 * t) + next, there);
      fans.join(static_cast<int>(3 * t) + k, first + (there - first + 1) % 3);
    }
  }
  return fans;
}

/// The mesh of some of a net's triangles.
MeasuredMesh mesh_of(const SurfaceNet& net, const std::vector<Index3>& triangles) {
  DisjointSets fans = fans_of(triangles);
  std::vector<int> vertex_of_fan(3 * triangles.size(), -1);
  MeasuredMesh result;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Index3 triangle;
    bool is_seen = true;
    for (int k = 0; k < 3; ++k) {
      const NetVertex& vertex = net.vertices[static_cast<std::size_t>(triangles[t][k])];
      int& number = vertex_of_fan[static_cast<std::size_t>(fans.root(static_cast<int>(3 * t) + k))];
      if (number < 0) {
        number = static_cast<int>(result.mesh.vertices.size());
        result.mesh.vertices.emplace_back(vertex.position.cast<double>());
        result.sigma.push_back(vertex.is_seen ? vertex.sigma : 0);
      }
      triangle[k] = number;
      is_seen = is_seen && vertex.is_seen;
    }
    result.mesh.triangles.push_back(triangle);
    result.is_cap.push_back(is_seen ? 0 : 1);
  }
  return result;
}

}  // namespace

MeasuredMesh open_mesh(const SurfaceNet& net, int least_frames) {
  std::vector<Index3> seen;
  std::copy_if(net.triangles.begin(), net.triangles.end(), std::back_inserter(seen), [&](const Index3& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](int vertex) { return net.vertices[static_cast<std::size_t>(vertex)].is_seen; });
  });
  return mesh_of(net, parts_of(net, seen, [&](const Part& part) { return part.frames.count() >= least_frames; }));
}

MeasuredMesh closed_mesh(const SurfaceNet& net, int least_frames) {
  return mesh_of(net, parts_of(net, net.triangles, [&](const Part& part) {
                   return part.frames.count() >= least_frames && part.six_volumes > 0;
                 }));
}

}  // namespace vantage
