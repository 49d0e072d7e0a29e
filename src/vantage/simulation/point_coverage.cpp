#include "vantage/simulation/point_coverage.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/point_tree.hpp"

namespace vantage {
void PointMetric::validate() const {
  require(samples > 0, "samples = ", samples, ": must be positive");
  require(tolerance > 0 && std::isfinite(tolerance), "tolerance = ", tolerance, " m: must be positive");
}

PointCoverage::PointCoverage(const TriangleMesh& mesh, const PointMetric& metric) : tolerance_(metric.tolerance) {
  metric.validate();
  Random random(1);
  for (const MeshSample& sample : sample_surface(mesh, metric.samples, random)) samples_.push_back(sample.point);
  is_near_.assign(samples_.size(), 0);
  counts_.assign(samples_.size(), 1);
}

void PointCoverage::add(const std::vector<Vec3>& points) {
  if (points.empty()) return;
  const TreePoints cloud{&points};
  const PointTree tree(3, cloud);
  parallel_for(samples_.size(), [&](std::size_t i) {
    if (is_near_[i] != 0) return;
    std::uint32_t nearest = 0;  // nanoflann's index type
    double squared = 0;
    tree.knnSearch(samples_[i].data(), 1, &nearest, &squared);
    is_near_[i] = squared <= tolerance_ * tolerance_ ? 1 : 0;
  });
}

void PointCoverage::count_only(const PointCoverage& reachable) {
  require(reachable.samples_ == samples_, "point coverage: the samples of both must be the same");
  counts_ = reachable.is_near_;
}

double PointCoverage::share() const {
  std::size_t counted = 0;
  std::size_t near = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    counted += counts_[i] != 0 ? 1 : 0;
    near += counts_[i] != 0 && is_near_[i] != 0 ? 1 : 0;
  }
  return counted > 0 ? static_cast<double>(near) / static_cast<double>(counted) : 0;
}

}  // namespace vantage
