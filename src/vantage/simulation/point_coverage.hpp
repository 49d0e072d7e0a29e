#pragma once

#include <vector>

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// How publications count that compare clouds: samples of the true surface that have a scanned point nearby.
struct PointMetric {
  int samples = 10'000;      // that stand for equal areas
  double tolerance = 0.005;  // metres
  bool reachable = false;    // count only samples that a noise-free scan from some candidate puts a point near

  void validate() const;
};

/// Such samples of one surface, and which of them scans have come near to.
class PointCoverage {
 public:
  PointCoverage(const TriangleMesh& mesh, const PointMetric& metric);

  /// Points of a scan, world frame.
  void add(const std::vector<Vec3>& points);
  /// From now on only samples that `reachable`, which must be of the same mesh and metric, has near points count.
  void count_only(const PointCoverage& reachable);
  /// Of the samples that count; 0 where none does.
  [[nodiscard]] double share() const;

 private:
  std::vector<Vec3> samples_;
  std::vector<char> is_near_, counts_;
  double tolerance_;
};

}  // namespace vantage
