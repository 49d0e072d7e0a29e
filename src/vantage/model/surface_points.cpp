#include "vantage/model/surface_points.hpp"

#include <algorithm>
#include <atomic>

#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/model/surface_fusion.hpp"
#include "vantage/model/surface_key_set.hpp"
#include "vantage/registration/point_index.hpp"

namespace vantage {
namespace {

constexpr double least_cosine_of_points = 0.1;
constexpr float least_cosine_along_band = 0.25F;  // the band along a grazing sight line is no longer than this asks for

float reach_along(const SurfacePoints::Point& point, float band) {
  return band / std::max(least_cosine_along_band, -point.normal.dot(point.direction));
}

/// Which nodes of each block something holds for; setting is safe from several threads and in any order.
class NodeBits {
 public:
  explicit NodeBits(std::size_t blocks) : words_(blocks * words_per_block) {}
  void set(std::size_t block, std::size_t node) {
    words_[block * words_per_block + node / 64].fetch_or(std::uint64_t{1} << (node % 64), std::memory_order_relaxed);
  }
  [[nodiscard]] bool test(std::size_t block, std::size_t node) const {
    return (words_[block * words_per_block + node / 64].load(std::memory_order_relaxed) >> (node % 64) & 1U) != 0;
  }

 private:
  static constexpr std::size_t words_per_block = SurfaceBlock::size / 64;
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// What the points of a scan near one node say together.
struct NodeSum {
  float closeness = 0, distance = 0, weight = 0;
  Vec3f normal = Vec3f::Zero();
};

/// Writes the points of one scan into one block after the other.
class PointFuser {
 public:
  PointFuser(const SurfacePoints& points, double cell, std::uint16_t number)
      : points_(points),
        cell_(static_cast<float>(cell)),
        band_(surface_band(static_cast<float>(points.sigma()), cell_)),
        sigma_(static_cast<float>(points.sigma())),
        radius_(static_cast<float>(std::max(cell, points.spacing()))),
        number_(number) {}

  void fuse(SurfaceBlock& block, std::size_t block_number, std::span<const std::uint32_t> points,
            NodeBits& seen) const {
    std::array<NodeSum, SurfaceBlock::size> sums{};
    for (const std::uint32_t i : points) add(points_.points()[i], block, sums);
    for (std::size_t node = 0; node < sums.size(); ++node) {
      const NodeSum& sum = sums[node];
      if (sum.closeness <= 0) continue;
      const float distance = sum.distance / sum.closeness;
      const float certainty = std::clamp((band_ + distance) / (band_ - 2 * sigma_), 0.0F, 1.0F);
      const float norm = sum.normal.norm();
      if (certainty <= 0 || norm <= 0) continue;
      block.add(node, {distance, certainty * sum.weight / sum.closeness, sum.normal / norm, certainty, number_});
      seen.set(block_number, node);
    }
  }

 private:
  void add(const SurfacePoints::Point& point, const SurfaceBlock& block,
           std::array<NodeSum, SurfaceBlock::size>& sums) const {
    const float reach = reach_along(point, band_);
    const Vec3f first = cell_ * static_cast<float>(SurfaceBlock::side_length) * block.key.cast<float>();
    const Vec3f from = (point.place - reach * point.direction - first) / cell_;
    const Vec3f to = (point.place + reach * point.direction - first) / cell_;
    const float across = radius_ / cell_;
    const Vec3f low = from.cwiseMin(to).array() - across, high = from.cwiseMax(to).array() + across;
    Index3 begin, end;
    for (int i = 0; i < 3; ++i) {
      begin[i] = static_cast<int>(std::ceil(std::max(low[i], 0.0F)));
      end[i] = static_cast<int>(std::floor(std::min(high[i], static_cast<float>(SurfaceBlock::side_length - 1))));
    }
    for (int z = begin.z(); z <= end.z(); ++z) {
      for (int y = begin.y(); y <= end.y(); ++y) {
        for (int x = begin.x(); x <= end.x(); ++x) {
          const Vec3f offset =
              first + cell_ * Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) - point.place;
          const float along = offset.dot(point.direction);
          const float beside = offset.squaredNorm() - along * along;
          const float distance = point.normal.dot(offset);
          if (beside >= radius_ * radius_ || std::abs(along) > reach || std::abs(distance) > band_) continue;
          const float closeness = 1 - beside / (radius_ * radius_);
          NodeSum& sum = sums[SurfaceBlock::index(x, y, z)];
          sum.closeness += closeness;
          sum.distance += closeness * distance;
          sum.weight += closeness * point.weight;
          sum.normal += closeness * point.normal;
        }
      }
    }
  }

  const SurfacePoints& points_;
  float cell_, band_, sigma_, radius_;
  std::uint16_t number_;
};

/// Calls `visit(t)` for steps of at most one cell along the part of a line that lies in the region.
template <class Visit>
void walk(const SurfacePoints::Line& line, const Box3& region, double cell, double margin, const Visit& visit) {
  const Vec3 whole = line.to - line.from;
  const double length = whole.norm();
  if (!(length > margin)) return;
  double first = 0, last = 1 - margin / length;
  for (int i = 0; i < 3; ++i) {
    if (whole[i] == 0) {
      if (line.from[i] < region.min()[i] || line.from[i] > region.max()[i]) return;
      continue;
    }
    const double a = (region.min()[i] - line.from[i]) / whole[i], b = (region.max()[i] - line.from[i]) / whole[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first > last) return;
  const int steps = static_cast<int>(std::ceil((last - first) * length / cell));
  for (int i = 0; i <= steps; ++i)
    visit(Vec3(line.from + (last - (steps == 0 ? 0 : (last - first) * i / steps)) * whole));
}

}  // namespace

SurfacePoints::SurfacePoints(const PointScan& scan, const View& view, const SurfaceNoise& noise, const Box3& region) {
  const Pose& pose = view.world_from_sensor;
  std::vector<double> depths;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vec3 origin = scan.origins.empty() ? Vec3(Vec3::Zero()) : scan.origins[scan.origins.size() == 1 ? 0 : i];
    const Vec3 from = pose * origin, to = pose * scan.points[i];
    lines_.push_back({from, to});
    const double length = (to - from).norm();
    if (!region.contains(to) || !(length > 0)) continue;
    const Vec3 direction = (to - from) / length;
    Vec3 normal = scan.normals.empty() ? Vec3(Vec3::Zero()) : Vec3(pose.linear() * scan.normals[i].cast<double>());
    if (!(normal.dot(direction) < 0)) normal = -direction;
    depths.push_back(length);
    points_.push_back({to.cast<float>(), direction.cast<float>(), normal.cast<float>(),
                       static_cast<float>(std::max(least_cosine_of_points, -normal.dot(direction)))});
  }
  if (points_.empty()) return;
  measure_spacing_and_sigma(noise.sigma(upper_median(depths)));
  for (Point& point : points_) point.weight /= static_cast<float>(sigma_ * sigma_);
}

void SurfacePoints::measure_spacing_and_sigma(double given_sigma) {
  constexpr std::size_t most_queries = 4000, neighbours = 5;  // the point itself is one
  constexpr double least_sigma_in_spacings = 0.02;            // even of a perfect sensor
  std::vector<Vec3> places;
  places.reserve(points_.size());
  for (const Point& point : points_) places.emplace_back(point.place.cast<double>());
  const PointIndex index(std::move(places));
  std::vector<double> spacings, deviations;
  const std::size_t step = (points_.size() + most_queries - 1) / most_queries;
  for (std::size_t i = 0; i < points_.size(); i += step) {
    const std::vector<Neighbor> near = index.nearest(index.points()[i], neighbours);
    spacings.push_back(std::sqrt(near.back().squared_distance));
    for (const Neighbor& other : near) {
      if (other.index == i) continue;
      deviations.push_back(
          std::abs(static_cast<double>(points_[i].normal.dot(points_[other.index].place - points_[i].place))));
    }
  }
  spacing_ = upper_median(spacings);
  if (!(spacing_ > 0)) spacing_ = given_sigma;
  const double scatter = deviations.empty() ? 0 : upper_median(deviations) / 0.67449 / std::sqrt(2.0);
  sigma_ = std::max({given_sigma, scatter, least_sigma_in_spacings * spacing_, 1e-9});
  if (!(spacing_ > 0)) spacing_ = sigma_;
}

std::vector<Index3> blocks_near(const SurfacePoints& points, double cell, const Box3& region) {
  const double block = cell * SurfaceBlock::side_length;
  const float margin = 1.5F / SurfaceBlock::side_length;
  const float band = surface_band(static_cast<float>(points.sigma()), static_cast<float>(cell));
  const Box3 inside(region.min() - Vec3::Constant(1.5 * cell), region.max() + Vec3::Constant(1.5 * cell));
  KeySet keys;
  for (const SurfacePoints::Point& point : points.points()) {
    const float reach = reach_along(point, band);
    const int steps = std::max(1, static_cast<int>(std::ceil(4 * reach / static_cast<float>(block))));
    for (int i = 0; i <= steps; ++i) {
      const float t = reach * (2 * static_cast<float>(i) / static_cast<float>(steps) - 1);
      const Vec3 place = (point.place + t * point.direction).cast<double>();
      if (inside.contains(place)) keys.insert_around((place / block).cast<float>(), margin);
    }
  }
  std::vector<std::uint64_t> sorted = keys.keys();
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index3> result;
  result.reserve(sorted.size());
  for (const std::uint64_t key : sorted) result.push_back(unpacked_key(key));
  return result;
}

void fuse(SurfaceBlocks& blocks, const SurfacePoints& points, const Box3& region, std::uint16_t number) {
  const double cell = blocks.cell(), block_length = blocks.block_length();
  const float band = surface_band(static_cast<float>(points.sigma()), static_cast<float>(cell));
  const float margin =
      static_cast<float>(std::max(cell, points.spacing()) / block_length) + 0.5F / SurfaceBlock::side_length;
  std::unordered_map<std::uint64_t, std::size_t> number_of_key;
  for (std::size_t i = 0; i < blocks.size(); ++i) number_of_key.emplace(packed_key(blocks.all()[i]->key), i);
  std::vector<std::vector<std::uint32_t>> points_of_block(blocks.size());
  for (std::size_t i = 0; i < points.points().size(); ++i) {
    const SurfacePoints::Point& point = points.points()[i];
    const float reach = reach_along(point, band);
    KeySet keys(16);
    const int steps = std::max(1, static_cast<int>(std::ceil(4 * reach / static_cast<float>(block_length))));
    for (int k = 0; k <= steps; ++k) {
      const float t = reach * (2 * static_cast<float>(k) / static_cast<float>(steps) - 1);
      keys.insert_around((point.place + t * point.direction) / static_cast<float>(block_length), margin);
    }
    for (const std::uint64_t key : keys.keys()) {
      const auto found = number_of_key.find(key);
      if (found != number_of_key.end()) points_of_block[found->second].push_back(static_cast<std::uint32_t>(i));
    }
  }
  NodeBits seen(blocks.size()), passed(blocks.size());
  const PointFuser fuser(points, cell, number);
  parallel_for(blocks.size(), [&](std::size_t i) { fuser.fuse(*blocks.all()[i], i, points_of_block[i], seen); });
  parallel_for(points.lines().size(), [&](std::size_t i) {
    walk(points.lines()[i], region, cell, static_cast<double>(band), [&](const Vec3& place) {
      const Index3 node = (place / cell).array().round().matrix().cast<int>();
      const Index3 key = node.unaryExpr([](int value) { return value >> 3; });
      const auto found = number_of_key.find(packed_key(key));
      if (found == number_of_key.end()) return;
      const Index3 local = node - SurfaceBlock::side_length * key;
      passed.set(found->second, SurfaceBlock::index(local.x(), local.y(), local.z()));
    });
  });
  parallel_for(blocks.size(), [&](std::size_t i) {
    for (std::size_t node = 0; node < SurfaceBlock::size; ++node) {
      std::uint16_t& count = blocks.all()[i]->nodes[node].looked_through;
      if (passed.test(i, node) && !seen.test(i, node) && count < 65535) ++count;
    }
  });
}

}  // namespace vantage
