#include "vantage/registration/surfels.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/registration/lattice.hpp"

namespace vantage {
namespace {

/// The points of one side of the surface in a cell, as their moments about the cell's corner.
struct Cluster {
  LatticeCell cell;
  double count = 0;
  Vec3 sum = Vec3::Zero();
  Mat3 squares = Mat3::Zero();
  Vec3 normal = Vec3::Zero();  // sum of the points' normals
  int next = -1;               // the cell's other side

  /// Noisy normals of one side stay together; those of the two sides of a wall are opposite.
  [[nodiscard]] bool is_other_side(const Vec3& other) const { return normal.dot(other) < -0.5 * normal.norm(); }
};

class Clusters {
 public:
  Clusters(const PointCloud& cloud, double cell) : lattice_{cell} {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!cloud.normals[i].isZero()) add(cloud.points[i], cloud.normals[i]);
    }
  }

  [[nodiscard]] std::size_t size() const { return clusters_.size(); }
  [[nodiscard]] Vec3 mean(const Cluster& cluster) const {
    return lattice_.corner(cluster.cell) + cluster.sum / cluster.count;
  }
  [[nodiscard]] const Cluster& operator[](std::size_t i) const { return clusters_[i]; }

  /// Calls `visit` for the clusters of the 27 cells around `cluster` that face the same way, itself included.
  template <class Visit>
  void for_each_neighbor(const Cluster& cluster, const Visit& visit) const {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto found = first_.find(cluster.cell.moved(dx, dy, dz));
          if (found == first_.end()) continue;
          for (int i = found->second; i >= 0; i = clusters_[static_cast<std::size_t>(i)].next) {
            const Cluster& other = clusters_[static_cast<std::size_t>(i)];
            if (other.normal.dot(cluster.normal) > least_cosine * other.normal.norm() * cluster.normal.norm())
              visit(other);
          }
        }
      }
    }
  }

 private:
  // Neighbours that turn by more than this belong to another face or to the back of a thin wall.
  static constexpr double least_cosine = 0.5;

  void add(const Vec3& point, const Vec3& normal) {
    const LatticeCell cell = lattice_.cell(point);
    const auto [entry, is_new] = first_.try_emplace(cell, static_cast<int>(clusters_.size()));
    int i = entry->second;
    if (is_new) {
      clusters_.push_back({.cell = cell});
    } else {
      while (clusters_[static_cast<std::size_t>(i)].is_other_side(normal)) {
        int& next = clusters_[static_cast<std::size_t>(i)].next;
        if (next < 0) {
          next = static_cast<int>(clusters_.size());
          clusters_.push_back({.cell = cell});
          i = static_cast<int>(clusters_.size()) - 1;
          break;
        }
        i = next;
      }
    }
    Cluster& cluster = clusters_[static_cast<std::size_t>(i)];
    const Vec3 offset = point - lattice_.corner(cell);  // small numbers: their squares cancel less
    cluster.count += 1;
    cluster.sum += offset;
    cluster.squares += offset * offset.transpose();
    cluster.normal += normal;
  }

  Lattice lattice_;
  std::vector<Cluster> clusters_;
  std::unordered_map<LatticeCell, int, LatticeCellHash> first_;
};

/// Moments of several clusters about one point.
struct Moments {
  double count = 0;
  Vec3 sum = Vec3::Zero();
  Mat3 squares = Mat3::Zero();

  void add(const Cluster& cluster, const Vec3& mean) {
    count += cluster.count;
    sum += cluster.count * mean;
    squares += cluster.squares - cluster.sum * cluster.sum.transpose() / cluster.count;
    squares += cluster.count * mean * mean.transpose();
  }
};

struct Plane {
  Vec3 normal = Vec3::Zero();
  bool is_flat = false;
};

/// The plane through points that spread in two directions and little in the third.
Plane fit_plane(const Moments& moments, double cell) {
  constexpr double least_points = 5;
  if (moments.count < least_points) return {};
  const Vec3 mean = moments.sum / moments.count;
  const Mat3 covariance = moments.squares / moments.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(covariance);
  const Vec3 spreads = solver.eigenvalues();  // ascending variances
  // A square of one cell has a variance of cell^2/12 each way; a line or a speck has not.
  const bool is_broad = spreads[1] > 0.03 * cell * cell;
  return {solver.eigenvectors().col(0), is_broad && spreads[0] < 0.05 * spreads[1]};
}

}  // namespace

double Surfels::flat_share() const {
  if (is_flat.empty()) return 0;
  return static_cast<double>(std::count(is_flat.begin(), is_flat.end(), 1)) / static_cast<double>(is_flat.size());
}

Surfels make_surfels(const PointCloud& cloud, double cell) {
  require(cell > 0 && std::isfinite(cell), "surfels: cell = ", cell, " m: must be positive");
  require(cloud.points.size() == cloud.normals.size(), "surfels: ", cloud.points.size(), " points with ",
          cloud.normals.size(), " normals; must be as many");
  const Clusters clusters(cloud, cell);
  Surfels surfels{.cloud = {}, .is_flat = std::vector<char>(clusters.size(), 0), .cell = cell};
  surfels.cloud.points.resize(clusters.size());
  surfels.cloud.normals.resize(clusters.size());
  parallel_for(clusters.size(), [&](std::size_t i) {
    const Cluster& cluster = clusters[i];
    const Vec3 here = clusters.mean(cluster);
    Moments around;
    clusters.for_each_neighbor(cluster, [&](const Cluster& other) { around.add(other, clusters.mean(other) - here); });
    Moments inside;
    inside.add(cluster, Vec3::Zero());
    Plane plane = fit_plane(inside, cell);
    if (!plane.is_flat) plane = fit_plane(around, cell);
    Vec3 normal = plane.is_flat ? plane.normal : Vec3(cluster.normal.normalized());
    if (normal.dot(cluster.normal) < 0) normal = -normal;
    surfels.cloud.points[i] = here;
    surfels.cloud.normals[i] = normal;
    surfels.is_flat[i] = plane.is_flat ? 1 : 0;
  });
  return surfels;
}

}  // namespace vantage
