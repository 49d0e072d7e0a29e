#pragma once

#include <unordered_map>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/registration/lattice.hpp"

namespace vantage {

/// Registered scans merged into one cloud in which overlaps are no denser than a single scan (the paper's section 3:
/// "the redundancy between the overlapped areas is decreased"). Per cell of a lattice, and per side of a thin wall, the
/// point seen most perpendicularly is kept; of equals the first. Points without a normal are kept only where the cell
/// has none with a normal.
class FusedCloud {
 public:
  /// `spacing`: side of the cells in metres. Throws InputError unless it is positive.
  explicit FusedCloud(double spacing);

  /// Adds a scan, points and normals in the sensor frame, taken from `world_from_sensor`.
  void merge(const PointCloud& scan_in_sensor, const Pose& world_from_sensor);

  /// All kept points in the world frame, cells in the order in which they were first met.
  [[nodiscard]] const PointCloud& cloud() const { return cloud_; }
  /// Cosine between normal and direction to the sensor of each point of cloud(); 0 without a normal.
  [[nodiscard]] const std::vector<double>& quality() const { return quality_; }
  [[nodiscard]] double spacing() const { return lattice_.length; }

 private:
  Lattice lattice_;
  PointCloud cloud_;
  std::vector<double> quality_;
  std::vector<int> next_;  // the other side in the same cell, or -1
  std::unordered_map<LatticeCell, int, LatticeCellHash> first_;
};

}  // namespace vantage
