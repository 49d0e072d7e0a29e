#include "vantage/registration/surfels.hpp"

#include <Eigen/Eigenvalues>
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
      while (clusters_[static_cast<std::size_t>(i)].normal.dot(normal) < 0) {
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

}  // namespace

Surfels make_surfels(const PointCloud& cloud, double cell) {
  require(cell > 0 && std::isfinite(cell), "surfels: cell = ", cell, " m: must be positive");
  require(cloud.points.size() == cloud.normals.size(), "surfels: ", cloud.points.size(), " points with ",
          cloud.normals.size(), " normals; must be as many");
  const Clusters clusters(cloud, cell);
  Surfels surfels{.cloud = {}, .on_border = std::vector<char>(clusters.size(), 0), .cell = cell};
  surfels.cloud.points.resize(clusters.size());
  surfels.cloud.normals.resize(clusters.size());
  parallel_for(clusters.size(), [&](std::size_t i) {
    const Cluster& cluster = clusters[i];
    const Vec3 here = clusters.mean(cluster);
    double count = 0;
    Vec3 sum = Vec3::Zero();
    Mat3 squares = Mat3::Zero();
    int cells = 0;
    Vec3 sum_of_means = Vec3::Zero();
    clusters.for_each_neighbor(cluster, [&](const Cluster& other) {
      const Vec3 mean = clusters.mean(other) - here;
      const Mat3 spread = other.squares - other.sum * other.sum.transpose() / other.count;
      count += other.count;
      sum += other.count * mean;
      squares += spread + other.count * mean * mean.transpose();
      sum_of_means += mean;
      ++cells;
    });
    const Mat3 covariance = squares / count - sum * sum.transpose() / (count * count);
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(covariance);
    const Vec3 spreads = solver.eigenvalues();
    // A plane needs extent in two directions; a row of cells has it in one only and keeps the mean normal.
    const bool is_plane = cells >= 4 && spreads[1] > 0.01 * cell * cell && spreads[0] < 0.5 * spreads[1];
    Vec3 normal = is_plane ? Vec3(solver.eigenvectors().col(0)) : cluster.normal.normalized();
    if (normal.dot(cluster.normal) < 0) normal = -normal;
    surfels.cloud.points[i] = here;
    surfels.cloud.normals[i] = normal;
    // Cells on all sides balance each other; on a straight border of the known surface their mean lies half a cell off.
    const Vec3 balance = sum_of_means / cells;
    surfels.on_border[i] = (balance - normal * normal.dot(balance)).norm() > 0.3 * cell || cells < 4 ? 1 : 0;
  });
  return surfels;
}

}  // namespace vantage
