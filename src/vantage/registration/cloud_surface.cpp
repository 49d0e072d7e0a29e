#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/registration/lattice.hpp"
#include "vantage/registration/point_index.hpp"
#include "vantage/registration/scan_surface.hpp"

namespace vantage {
namespace {

constexpr std::size_t least_neighbors = 6, most_neighbors = 64;

/// The plane through the neighbours of a point that face the same way, as far as it is known which way they face.
class Neighborhood {
 public:
  Neighborhood(const PointCloud& cloud, const PointIndex& index, double radius, std::size_t count)
      : cloud_(cloud), index_(index), radius_(radius), count_(count) {}

  struct Plane {
    Vec3 mean = Vec3::Zero(), normal = Vec3::Zero();  // the side of the normal is open
    double thickness = 0;                             // RMS distance of the neighbours, metres
    double count = 0;
  };

  [[nodiscard]] std::optional<Plane> plane(std::size_t point) const {
    const Vec3& here = cloud_.points[point];
    const Vec3& facing = cloud_.normals[point];
    Plane plane;
    Vec3 sum = Vec3::Zero();
    Mat3 squares = Mat3::Zero();
    for (const Neighbor& neighbor : index_.nearest(here, count_)) {
      if (neighbor.squared_distance > radius_ * radius_) break;
      if (cloud_.normals[neighbor.index].dot(facing) < 0) continue;
      const Vec3 offset = cloud_.points[neighbor.index] - here;
      sum += offset;
      squares += offset * offset.transpose();
      plane.count += 1;
    }
    if (plane.count < static_cast<double>(least_neighbors)) return std::nullopt;
    const Vec3 mean = sum / plane.count;
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(squares / plane.count - mean * mean.transpose());
    const Vec3 spreads = solver.eigenvalues();  // ascending variances
    // Points along a line, or in a ball, show no plane.
    if (!(spreads[1] > 0.05 * spreads[2]) || spreads[0] > 0.5 * spreads[1]) return std::nullopt;
    plane.mean = here + mean;
    plane.normal = solver.eigenvectors().col(0);
    plane.thickness = std::sqrt(std::max(0.0, spreads[0]));
    return plane;
  }

 private:
  const PointCloud& cloud_;
  const PointIndex& index_;
  double radius_;
  std::size_t count_;
};

/// One point per cell of a lattice: the first.
std::vector<std::size_t> one_per_cell(const std::vector<Vec3>& points, double length) {
  const Lattice lattice{length};
  std::unordered_set<LatticeCell, LatticeCellHash> taken;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (taken.insert(lattice.cell(points[i])).second) chosen.push_back(i);
  }
  return chosen;
}

double median_or_0(std::vector<double> values) { return values.empty() ? 0 : upper_median(std::move(values)); }

/// What a cloud shows of its own noise: the thickness of the planes through few neighbours, which hold half of it.
SensorModel measured_sensor(const PointCloud& cloud, const PointIndex& index, double spacing) {
  const Neighborhood around(cloud, index, 4 * spacing, 16);
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / 1000);
  std::vector<double> thicknesses;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    if (const auto plane = around.plane(i)) thicknesses.push_back(plane->thickness);
  }
  return {.constant = median_or_0(std::move(thicknesses))};
}

}  // namespace

ScanSurface scan_surface(const PointCloud& cloud, std::span<const Vec3> origins,
                         const std::optional<SensorModel>& given, const ScanSurfaceOptions& options) {
  options.validate();
  require(cloud.normals.size() == cloud.size(), "scan surface: ", cloud.size(), " points with ", cloud.normals.size(),
          " normals; must be as many");
  require(origins.size() == 1 || origins.size() == cloud.size(), "scan surface: ", cloud.size(), " points with ",
          origins.size(), " origins of sight lines; must be one, or as many");
  ScanSurface surface;
  if (cloud.size() < most_neighbors) return surface;
  const auto origin = [&](std::size_t i) -> const Vec3& { return origins[origins.size() == 1 ? 0 : i]; };
  const PointIndex index(cloud.points);
  const double spacing = point_spacing(index);
  if (!(spacing > 0)) return surface;  // the same point over and over
  const SensorModel sensor = given ? *given : measured_sensor(cloud, index, spacing);
  std::vector<double> distances;
  for (std::size_t i = 0; i < cloud.size(); i += cloud.size() / 1000 + 1) {
    distances.push_back((cloud.points[i] - origin(i)).norm());
  }
  surface.sigma = sensor.sigma(median_or_0(std::move(distances)));
  const double side = neighborhood_side(surface.sigma, spacing, options.normal_sigma);
  const double of_budget = spacing * std::sqrt(static_cast<double>(cloud.size()) / options.max_samples);
  surface.spacing = std::max({spacing, side / 2, of_budget});
  const double radius = std::max(2.5 * spacing, side / 2);
  const Neighborhood around(cloud, index, radius, most_neighbors);
  const std::vector<std::size_t> chosen = one_per_cell(cloud.points, surface.spacing);
  std::vector<std::optional<SurfaceSample>> samples(chosen.size());
  parallel_for(chosen.size(), [&](std::size_t k) {
    const std::size_t i = chosen[k];
    const auto plane = around.plane(i);
    if (!plane) return;
    const Vec3 back = origin(i) - cloud.points[i];
    const Vec3 outside = cloud.normals[i].isZero() ? back : cloud.normals[i];
    const Vec3 normal = plane->normal.dot(outside) < 0 ? Vec3(-plane->normal) : plane->normal;
    const double deviation = std::max(sensor.sigma(back.norm()), plane->thickness);
    samples[k] = {plane->mean, normal, deviation * std::max(1 / std::sqrt(plane->count), options.shared_error)};
  });
  for (const auto& sample : samples) {
    if (sample) surface.samples.push_back(*sample);
  }
  return surface;
}

}  // namespace vantage
