#include "vantage/registration/surface_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "vantage/core/parallel.hpp"
#include "vantage/registration/point_index.hpp"
#include "vantage/registration/surfel_map.hpp"

namespace vantage {
namespace {

constexpr int bins = 11;
constexpr double radius_in_cells = 5;
constexpr std::size_t most_neighbors = 100;
constexpr std::size_t thinned_places = 2500;  // of a scan
constexpr std::size_t most_places = 1200;     // that are compared

using Histogram = Eigen::Matrix<double, 3 * bins, 1>;

/// Counts a value of 0..1 in the two bins whose middles it lies between: noise then moves little from bin to bin.
void count(Histogram& histogram, int row, double value, double weight) {
  const double place = std::clamp(value, 0.0, 1.0) * bins - 0.5;
  const double low = std::floor(place);
  const double part = place - low;
  const int first = static_cast<int>(low);
  histogram[row * bins + std::clamp(first, 0, bins - 1)] += weight * (1 - part);
  histogram[row * bins + std::clamp(first + 1, 0, bins - 1)] += weight * part;
}

/// How the other sample's normal lies in the frame that the first one's normal and the line between them span.
void count_pair(Histogram& histogram, const SurfaceSample& here, const SurfaceSample& other) {
  const Vec3 line = other.point - here.point;
  const double length = line.norm();
  const Vec3 across = line.cross(here.normal);
  const double breadth = across.norm();
  if (!(length > 0) || !(breadth > 1e-6 * length)) return;
  const Vec3 v = across / breadth;
  const Vec3 w = here.normal.cross(v);
  const double turned = std::atan2(w.dot(other.normal), here.normal.dot(other.normal));
  count(histogram, 0, 0.5 + 0.5 * v.dot(other.normal), 1);
  count(histogram, 1, 0.5 + 0.5 * here.normal.dot(line) / length, 1);
  count(histogram, 2, 0.5 + 0.5 * turned / std::numbers::pi, 1);
}

SurfaceDescriptor as_descriptor(const Histogram& histogram) {
  SurfaceDescriptor descriptor = SurfaceDescriptor::Zero();
  const double sum = histogram.sum();
  if (sum > 0) descriptor.head<3 * bins>() = (histogram / sum).cwiseSqrt().cast<float>();
  return descriptor;
}

/// How little a neighbourhood's normals agree: 0 on a plane, more where a place differs from others.
double bend(std::span<const SurfaceSample> places, std::size_t here, std::span<const Neighbor> around) {
  Vec3 sum = places[here].normal;
  for (const Neighbor& neighbor : around) sum += places[neighbor.index].normal;
  return 1 - sum.norm() / (1 + static_cast<double>(around.size()));
}

/// The numbers of those that are bent most, in their order; of equals the first ones.
std::vector<std::size_t> most_bent(const std::vector<double>& bends) {
  std::vector<std::size_t> order(bends.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return bends[a] > bends[b]; });
  if (order.size() > most_places) order.resize(most_places);
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace

double feature_cell(const ScanSurface& scan) {
  return scan.spacing *
         std::max(1.0, std::sqrt(static_cast<double>(scan.samples.size()) / static_cast<double>(thinned_places)));
}

SurfaceFeatures surface_features(std::span<const SurfaceSample> samples, double cell) {
  SurfelMap thinned(cell);
  for (const SurfaceSample& sample : samples) thinned.add(sample);
  const std::span<const SurfaceSample> places = thinned.surfels();
  std::vector<Vec3> points;
  points.reserve(places.size());
  for (const SurfaceSample& place : places) points.push_back(place.point);
  const PointIndex index(std::move(points));

  const double radius = radius_in_cells * cell;
  std::vector<std::vector<Neighbor>> around(places.size());
  std::vector<Histogram> simple(places.size(), Histogram::Zero());
  std::vector<double> bends(places.size());
  parallel_for(places.size(), [&](std::size_t i) {
    around[i] = index.nearest(places[i].point, most_neighbors);
    std::erase_if(around[i], [&](const Neighbor& neighbor) {
      return neighbor.index == i || neighbor.squared_distance > radius * radius;
    });
    for (const Neighbor& neighbor : around[i]) count_pair(simple[i], places[i], places[neighbor.index]);
    if (const double sum = simple[i].sum(); sum > 0) simple[i] /= sum;
    bends[i] = bend(places, i, around[i]);
  });
  const std::vector<std::size_t> chosen = most_bent(bends);
  SurfaceFeatures features{.cell = cell, .places = {}, .descriptors = {}};
  features.places.resize(chosen.size());
  features.descriptors.resize(chosen.size());
  parallel_for(chosen.size(), [&](std::size_t k) {
    const std::size_t i = chosen[k];
    Histogram sum = Histogram::Zero();
    for (const Neighbor& neighbor : around[i])
      sum += simple[neighbor.index] * (cell / std::max(0.5 * cell, std::sqrt(neighbor.squared_distance)));
    const double others = sum.sum();
    features.places[k] = places[i];
    features.descriptors[k] = as_descriptor(others > 0 ? Histogram(simple[i] + sum / others) : simple[i]);
  });
  return features;
}

}  // namespace vantage
