#include "vantage/simulation/ground_truth.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <tuple>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/sensor/sight_line.hpp"
#include "vantage/simulation/point_tree.hpp"

namespace vantage {
namespace {

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

void GroundTruthOptions::validate() const { require(samples > 0, "samples = ", samples, ": must be positive"); }

GroundTruth::GroundTruth(const RangeScanner& scanner, const Grid& grid, const IndexBox& enclosure,
                         const RangeCamera& camera, std::span<const View> views, const GroundTruthOptions& options)
    : scanner_(&scanner), grid_(grid), enclosure_(enclosure) {
  options.validate();
  const VoxelMap map(grid, enclosure);  // checks both, and gives the layout of the bits
  layout_ = map.layout();
  visible_.words.assign(layout_.words(), 0);
  Random random(options.seed);
  samples_ = sample_surface(scanner.mesh(), options.samples, random);
  parallel_for(views.size(), [&](std::size_t i) { mark_visible(scanner.scan(camera, views[i]), views[i]); });
  count_samples();
}

void GroundTruth::mark_visible(const RangeImage& image, const View& view) {
  const RayGrid rays = image.camera.rays();
  const Mat3 rotation = view.world_from_sensor.linear();
  std::size_t pixel = 0;
  for (int row = 0; row < rays.resolution.rows; ++row) {
    for (int column = 0; column < rays.resolution.columns; ++column, ++pixel) {
      if (!RangeImage::is_hit(image.depth[pixel])) continue;
      // The same expression as SightLine::hit_point, so that a point falls into the voxel that integration gives it.
      const auto depth = static_cast<double>(image.depth[pixel]);
      const Vec3 point = view.position() + depth * ray_direction(rotation, rays.x(column), rays.y(row));
      const Index3 voxel = grid_.index_of(point);
      if (!enclosure_.contains(voxel)) continue;
      const Index3 local = voxel - enclosure_.min;
      const std::atomic_ref<std::uint64_t> word(visible_.words[layout_.word(local)]);
      const std::uint64_t bit = BitLayout::bit(local);
      if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
    }
  }
}

void GroundTruth::count_samples() {
  const auto same_voxel = [](const VoxelSamples& a, const VoxelSamples& b) {
    return a.word == b.word && a.bit == b.bit;
  };
  const auto merge_runs = [&](std::vector<VoxelSamples>& list) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (kept > 0 && same_voxel(list[kept - 1], list[i])) {
        list[kept - 1].samples += list[i].samples;
      } else {
        list[kept++] = list[i];
      }
    }
    list.resize(kept);
  };
  for (const MeshSample& sample : samples_) {
    const Index3 voxel = grid_.index_of(sample.point);
    if (!is_visible(voxel)) continue;
    const Index3 local = voxel - enclosure_.min;
    visible_surface_.push_back({layout_.word(local), BitLayout::bit(local), 1});
    ++visible_samples_;
  }
  // Neighbouring samples mostly share a voxel: merging them first leaves little to sort.
  merge_runs(visible_surface_);
  std::sort(visible_surface_.begin(), visible_surface_.end(), [](const VoxelSamples& a, const VoxelSamples& b) {
    return std::tie(a.word, a.bit, a.samples) < std::tie(b.word, b.bit, b.samples);
  });
  merge_runs(visible_surface_);
}

std::int64_t GroundTruth::covered_samples(const VoxelMap& map) const {
  require(map.grid().length == grid_.length && map.grid().min == grid_.min && map.grid().size == grid_.size &&
              map.enclosure().min == enclosure_.min && map.enclosure().max == enclosure_.max,
          "coverage: the map must have the grid and the enclosure of the ground truth");
  std::int64_t covered = 0;
  for (const VoxelSamples& voxel : visible_surface_) {
    if ((map.occupied().words[voxel.word] & voxel.bit) != 0) covered += voxel.samples;
  }
  return covered;
}

double GroundTruth::coverage(const VoxelMap& map) const { return share(covered_samples(map), visible_samples_); }

double GroundTruth::coverage_all(const VoxelMap& map) const {
  return share(covered_samples(map), static_cast<std::int64_t>(samples_.size()));
}

bool GroundTruth::is_visible(const Index3& voxel) const {
  if (!enclosure_.contains(voxel)) return false;
  const Index3 local = voxel - enclosure_.min;
  return (visible_.words[layout_.word(local)] & BitLayout::bit(local)) != 0;
}

std::int64_t GroundTruth::visible_voxels() const {
  std::int64_t count = 0;
  for (const std::uint64_t word : visible_.words) count += std::popcount(word);
  return count;
}

Accuracy GroundTruth::accuracy(const PointCloud& cloud) const {
  if (cloud.points.empty()) return {};
  std::vector<double> distances(cloud.points.size());
  parallel_for(distances.size(), [&](std::size_t i) { distances[i] = scanner_->distance(cloud.points[i]); });
  double squares = 0;
  for (const double distance : distances) squares += distance * distance;
  const auto count = static_cast<double>(distances.size());
  std::sort(distances.begin(), distances.end());
  return {std::sqrt(squares / count), sorted_quantile(distances, 0.95), distances.back()};
}

Completeness GroundTruth::completeness(const PointCloud& cloud, double tolerance) const {
  require(tolerance > 0 && std::isfinite(tolerance), "completeness: tolerance = ", tolerance, " m: must be positive");
  if (cloud.points.empty()) return {};
  const TreePoints points{&cloud.points};
  const PointTree tree(3, points);
  std::vector<std::uint8_t> is_near(samples_.size());
  parallel_for(samples_.size(), [&](std::size_t i) {
    std::uint32_t nearest = 0;  // nanoflann's index type
    double squared = 0;
    tree.knnSearch(samples_[i].point.data(), 1, &nearest, &squared);
    is_near[i] = squared <= tolerance * tolerance ? 1 : 0;
  });
  std::int64_t near_visible = 0;
  std::int64_t near_any = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (is_near[i] == 0) continue;
    ++near_any;
    if (is_visible(grid_.index_of(samples_[i].point))) ++near_visible;
  }
  return {share(near_visible, visible_samples_), share(near_any, static_cast<std::int64_t>(samples_.size()))};
}

std::vector<View> visibility_views(const Candidates& candidates) {
  const std::size_t step = candidates.kind == Candidates::Kind::grid ? 16 : 1;
  std::vector<View> views;
  for (std::size_t i = 0; i < candidates.views.size(); i += step) views.push_back(candidates.views[i]);
  return views;
}

}  // namespace vantage
