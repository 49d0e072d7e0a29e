#include "vantage/model/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/registration/lattice.hpp"
#include "vantage/registration/point_index.hpp"
#include "vantage/registration/surfels.hpp"

namespace vantage {
namespace {

using CellIndex = std::unordered_map<LatticeCell, int, LatticeCellHash>;

constexpr double reach_in_cells = 1.75;   // a surfel speaks for the corners this near
constexpr double kernel_in_cells = 0.75;  // width of its Gaussian weight

constexpr std::array<std::array<int, 3>, 8> corners_of_cube{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
constexpr std::array<std::pair<std::size_t, std::size_t>, 12> edges_of_cube{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Height above the surface that surfels describe around a place: the mean of their planes, near ones counting more.
/// Only surfels that face as the nearest one does take part, lest both sides of a thin wall cancel.
struct Height {
  double value = 0;
  Vec3 normal = Vec3::Zero();
};

class Surface {
 public:
  Surface(const Surfels& surfels, double cell) : surfels_(surfels), lattice_{cell} {
    find_corners();
    heights_.resize(corners_.size());
    parallel_for(corners_.size(), [&](std::size_t i) { heights_[i] = height(position(i), nearby_[i]); });
  }

  [[nodiscard]] TriangleMesh mesh() const {
    TriangleMesh mesh;
    CellIndex vertex_of_cube;
    for (const LatticeCell& corner : corners_) {
      for (const auto& shift : corners_of_cube) {  // every cube that touches a corner
        const LatticeCell cube = corner.moved(-shift[0], -shift[1], -shift[2]);
        if (vertex_of_cube.contains(cube)) continue;
        const auto vertex = vertex_in(cube);
        vertex_of_cube.emplace(cube, vertex ? static_cast<int>(mesh.vertices.size()) : -1);
        if (vertex) mesh.vertices.push_back(*vertex);
      }
    }
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) add_quad_across(i, axis, vertex_of_cube, mesh);
    }
    return mesh;
  }

 private:
  [[nodiscard]] Vec3 position(std::size_t corner) const { return lattice_.corner(corners_[corner]); }

  /// Lists the lattice corners near surfels, each with these surfels.
  void find_corners() {
    const double cell = lattice_.length;
    const int steps = static_cast<int>(std::ceil(reach_in_cells));
    for (std::size_t i = 0; i < surfels_.size(); ++i) {
      const Vec3& point = surfels_.cloud.points[i];
      const LatticeCell home = lattice_.cell(point);
      for (int z = 1 - steps; z <= steps; ++z) {
        for (int y = 1 - steps; y <= steps; ++y) {
          for (int x = 1 - steps; x <= steps; ++x) {
            const LatticeCell corner = home.moved(x, y, z);
            if ((lattice_.corner(corner) - point).norm() > reach_in_cells * cell) continue;
            const auto [entry, is_new] = corner_index_.try_emplace(corner, static_cast<int>(corners_.size()));
            if (is_new) {
              corners_.push_back(corner);
              nearby_.emplace_back();
            }
            nearby_[static_cast<std::size_t>(entry->second)].push_back(i);
          }
        }
      }
    }
  }

  [[nodiscard]] Height height(const Vec3& place, const std::vector<std::size_t>& surfels) const {
    const auto& points = surfels_.cloud.points;
    const auto& normals = surfels_.cloud.normals;
    const auto nearer = [&](std::size_t a, std::size_t b) {
      return (points[a] - place).squaredNorm() < (points[b] - place).squaredNorm();
    };
    const std::size_t nearest = *std::min_element(surfels.begin(), surfels.end(), nearer);
    const double width = kernel_in_cells * lattice_.length;
    double weights = 0;
    Height sum;
    for (const std::size_t i : surfels) {
      if (normals[i].dot(normals[nearest]) <= 0) continue;
      const Vec3 offset = place - points[i];
      const double weight = std::exp(-offset.squaredNorm() / (width * width));
      weights += weight;
      sum.value += weight * normals[i].dot(offset);
      sum.normal += weight * normals[i];
    }
    return {sum.value / weights, sum.normal.normalized()};
  }

  /// The vertex of a cube: the mean of the points where its edges cross the surface, moved onto it.
  [[nodiscard]] std::optional<Vec3> vertex_in(const LatticeCell& cube) const {
    std::array<int, 8> corners{};
    for (std::size_t k = 0; k < 8; ++k) {
      const auto& shift = corners_of_cube[k];
      const auto found = corner_index_.find(cube.moved(shift[0], shift[1], shift[2]));
      corners[k] = found == corner_index_.end() ? -1 : found->second;
    }
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    int near_crossing = -1;
    for (const auto& [a, b] : edges_of_cube) {
      if (corners[a] < 0 || corners[b] < 0) continue;
      const auto from = static_cast<std::size_t>(corners[a]), to = static_cast<std::size_t>(corners[b]);
      if (is_inside(from) == is_inside(to)) continue;
      const double share = heights_[from].value / (heights_[from].value - heights_[to].value);
      sum += position(from) + share * (position(to) - position(from));
      ++crossings;
      near_crossing = corners[a];
    }
    if (crossings == 0) return std::nullopt;
    const Vec3 mean = sum / crossings;
    const Height above = height(mean, nearby_[static_cast<std::size_t>(near_crossing)]);
    const double limit = lattice_.length / 2;
    return Vec3(mean - std::clamp(above.value, -limit, limit) * above.normal);
  }

  /// Corners on the surface up to rounding count as outside, lest a plane along the lattice crumple.
  [[nodiscard]] bool is_inside(std::size_t corner) const { return heights_[corner].value < -1e-9 * lattice_.length; }

  /// Where the edge from a corner along an axis crosses the surface: two triangles between the four cubes around it.
  void add_quad_across(std::size_t corner, int axis, const CellIndex& vertex_of_cube, TriangleMesh& mesh) const {
    const auto moved = [](const LatticeCell& cell, int along, int by) {
      return cell.moved(along == 0 ? by : 0, along == 1 ? by : 0, along == 2 ? by : 0);
    };
    const auto next = corner_index_.find(moved(corners_[corner], axis, 1));
    if (next == corner_index_.end()) return;
    const bool leaves = is_inside(corner);
    if (leaves == is_inside(static_cast<std::size_t>(next->second))) return;
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    const LatticeCell here = corners_[corner];
    // Counter-clockwise seen from the axis' far end.
    const std::array<LatticeCell, 4> cubes{moved(moved(here, right, -1), up, -1), moved(here, up, -1), here,
                                           moved(here, right, -1)};
    std::array<int, 4> quad{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = vertex_of_cube.find(cubes[k]);
      if (found == vertex_of_cube.end() || found->second < 0) return;
      quad[k] = found->second;
    }
    if (!leaves) std::swap(quad[1], quad[3]);
    const auto vertex = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(quad[k])]; };
    const bool first_is_shorter = (vertex(0) - vertex(2)).squaredNorm() <= (vertex(1) - vertex(3)).squaredNorm();
    const std::size_t from = first_is_shorter ? 0 : 1;
    const auto index = [&](std::size_t k) { return quad[(from + k) % 4]; };
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
      const Index3 triangle(index(0), index(k), index(k + 1));
      const Vec3 a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
      const Vec3 b = mesh.vertices[static_cast<std::size_t>(triangle[1])];
      const Vec3 c = mesh.vertices[static_cast<std::size_t>(triangle[2])];
      if ((b - a).cross(c - a).norm() > 1e-9 * lattice_.length * lattice_.length) mesh.triangles.push_back(triangle);
    }
  }

  const Surfels& surfels_;
  Lattice lattice_;
  std::vector<LatticeCell> corners_;  // in the order in which surfels meet them
  CellIndex corner_index_;
  std::vector<std::vector<std::size_t>> nearby_;  // surfels in reach, per corner
  std::vector<Height> heights_;                   // per corner
};

}  // namespace

void SurfaceMeshOptions::validate() const {
  require(!cell || (*cell > 0 && std::isfinite(*cell)), "cell = ", cell.value_or(0), " m: must be positive");
  require(most_cells > 0, "most_cells = 0: must be positive");
}

TriangleMesh surface_mesh(const PointCloud& cloud, const SurfaceMeshOptions& options) {
  options.validate();
  constexpr std::size_t least_points = 5;
  if (cloud.size() < least_points) return {};
  double cell = options.cell ? *options.cell : 2 * point_spacing(PointIndex(cloud.points));
  Surfels surfels = make_surfels(cloud, cell);
  while (surfels.size() > options.most_cells) {
    cell *= 1.25;
    surfels = make_surfels(cloud, cell);
  }
  return Surface(surfels, cell).mesh();
}

}  // namespace vantage
