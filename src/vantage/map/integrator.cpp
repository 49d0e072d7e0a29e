#include "vantage/map/integrator.hpp"

#include <bit>
#include <cmath>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/map/block_pixels.hpp"
#include "vantage/map/look_through.hpp"
#include "vantage/map/point_support.hpp"
#include "vantage/map/sensor_distance.hpp"
#include "vantage/map/voxel_ray.hpp"

namespace vantage {
namespace {

constexpr int block_side = BlockPixels::side;
static_assert(64 % block_side == 0, "a block's row lies in one word");

/// Marks what a scan empties and occludes in blocks of voxels, straight in the words of the map.
class BlockCarver {
 public:
  BlockCarver(VoxelMap& map, const RangeImage& image, const View& view, const StepCounts& steps,
              const ScanLimits& limits, const LatticeProjection& projection)
      : map_(map),
        camera_(image.camera),
        rays_(image.camera.rays()),
        rotation_(view.world_from_sensor.linear()),
        eye_(view.position()),
        steps_(steps),
        limits_(limits),
        projection_(projection) {}

  /// All blocks of the layer that begins at local index z. Layers may run at the same time.
  void carve_layer(int z) {
    const Index3& size = map_.layout().size;
    for (int y = 0; y < size.y(); y += block_side) {
      for (int x = 0; x < size.x(); x += block_side) carve_block({x, y, z});
    }
  }

 private:
  enum class Fate { unchanged, emptied, occluded };
  using Kind = LatticeProjection::Footprint::Kind;

  [[nodiscard]] std::uint64_t open(std::size_t word) const {
    return ~(map_.occupied().words[word] | map_.empty().words[word]);
  }
  [[nodiscard]] std::uint64_t unmarked(std::size_t word) const { return open(word) & ~map_.hidden().words[word]; }
  void carve_block(const Index3& low) {
    const Index3 high = (low + Index3::Constant(block_side)).cwiseMin(map_.layout().size);
    const auto width = static_cast<unsigned>(high.x() - low.x());
    const std::uint64_t columns = ((std::uint64_t{1} << width) - 1) << (static_cast<unsigned>(low.x()) & 63U);
    const auto for_each_word = [&](const auto& body) {
      for (int z = low.z(); z < high.z(); ++z) {
        for (int y = low.y(); y < high.y(); ++y) body(map_.layout().word({low.x(), y, z}), y, z);
      }
    };
    std::uint64_t any_open = 0;
    std::uint64_t any_unmarked = 0;
    for_each_word([&](std::size_t word, int, int) {
      any_open |= open(word) & columns;
      any_unmarked |= unmarked(word) & columns;
    });
    if (any_open == 0) return;
    const LatticeProjection::Footprint footprint = projection_.footprint(low, high);
    if (footprint.kind == Kind::none) return;
    const bool dense = projection_.is_dense(footprint);
    const LimitRange range = limits_.range(footprint.pixels);
    const auto [least, most] = steps_.range(low, high);
    if (least >= range.most_emptied()) {  // nothing is emptied
      if (any_unmarked == 0 || most <= range.least_occluded()) return;
      if (dense && least > range.most_occluded()) {
        for_each_word([&](std::size_t word, int, int) { map_.carve_word(word, 0, columns); });
        return;
      }
    } else if (dense && most < range.least_emptied()) {
      for_each_word([&](std::size_t word, int, int) { map_.carve_word(word, columns, 0); });
      return;
    }
    if (footprint.kind == Kind::anywhere) {
      for_each_word([&](std::size_t word, int y, int z) {
        carve_row(word, {low.x(), y, z}, columns, [&](const Index3& voxel, bool is_unmarked) {
          const PixelRect pixels = projection_.footprint(voxel, voxel + Index3::Ones()).pixels;
          return fate_among(pixels, voxel, is_unmarked, false);
        });
      });
      return;
    }
    const BlockPixels block(projection_, low, map_.layout().size, footprint);
    for_each_word([&](std::size_t word, int y, int z) {
      carve_row(word, {low.x(), y, z}, columns, [&](const Index3& voxel, bool is_unmarked) {
        bool is_occluded = false;
        if (dense) {
          const auto [column, row] = block.nearest_to_center(voxel - low);
          const PixelLimits limits = limits_.at(column, row);
          const int steps = steps_.of(voxel);
          if (steps < limits.emptied_below) return Fate::emptied;
          is_occluded = steps > limits.occluded_above;
        }
        return fate_among(block.rect(voxel - low), voxel, is_unmarked, is_occluded);
      });
    });
  }

  /// Gives the open voxels of a block's row, which begins at local index `first`, the fate that `fate_of` tells.
  template <class FateOf>
  void carve_row(std::size_t word, const Index3& first, std::uint64_t columns, const FateOf& fate_of) {
    std::uint64_t emptied = 0;
    std::uint64_t occluded = 0;
    const std::uint64_t unmarked_here = unmarked(word);
    for (std::uint64_t bits = open(word) & columns; bits != 0; bits &= bits - 1) {
      const std::uint64_t bit = bits & (~bits + 1);
      const Index3 voxel((first.x() & ~63) + std::countr_zero(bits), first.y(), first.z());
      const Fate fate = fate_of(voxel, (unmarked_here & bit) != 0);
      if (fate == Fate::emptied) emptied |= bit;
      if (fate == Fate::occluded) occluded |= bit;
    }
    map_.carve_word(word, emptied, occluded);
  }

  /// What the pixels that may see a voxel make of it, one of which is known to occlude it or not.
  [[nodiscard]] Fate fate_among(const PixelRect& pixels, const Index3& voxel, bool is_unmarked,
                                bool is_occluded) const {
    if (pixels.is_empty()) return Fate::unchanged;
    const int steps = steps_.of(voxel);
    const LimitRange range = limits_.range(pixels);
    const auto empties = [steps](const PixelLimits& limits) { return steps < limits.emptied_below; };
    if (steps < range.most_emptied() && any_pixel(voxel, pixels, empties)) return Fate::emptied;
    if (!is_unmarked) return Fate::unchanged;
    const auto occludes = [steps](const PixelLimits& limits) { return steps > limits.occluded_above; };
    if (is_occluded || (steps > range.least_occluded() && any_pixel(voxel, pixels, occludes))) return Fate::occluded;
    return Fate::unchanged;
  }

  /// Does the ray of any of the pixels whose limits are `wanted` pass the voxel?
  template <class Wanted>
  [[nodiscard]] bool any_pixel(const Index3& voxel, const PixelRect& pixels, const Wanted& wanted) const {
    const Index3 in_scene = voxel + map_.enclosure().min;
    const Index3 eye_in_scene = steps_.eye + map_.enclosure().min;
    for (int row = pixels.top; row <= pixels.bottom; ++row) {
      const PixelLimits* const limits = limits_.row_of(row);
      for (int column = pixels.left; column <= pixels.right; ++column) {
        if (!wanted(limits[column])) continue;
        const LatticeRay ray(eye_, eye_in_scene, ray_direction(rotation_, rays_.x(column), rays_.y(row)));
        if (passes_voxel(map_.grid(), ray, in_scene, camera_.min_depth, LatticeRay::never)) return true;
      }
    }
    return false;
  }

  VoxelMap& map_;
  const RangeCamera& camera_;
  RayGrid rays_;
  Mat3 rotation_;
  Vec3 eye_;
  const StepCounts& steps_;
  const ScanLimits& limits_;
  const LatticeProjection& projection_;
};

/// Whether any measured point has a normal; a scan without any says nothing by their absence.
bool has_any_normal(const RangeImage& image, std::span<const Vec3f> normals_in_sensor) {
  for (std::size_t pixel = 0; pixel < normals_in_sensor.size(); ++pixel) {
    if (!normals_in_sensor[pixel].isZero(0) && RangeImage::is_hit(image.depth[pixel])) return true;
  }
  return false;
}

IntegrationReport add_points(VoxelMap& map, PointSupport& support, const ScanLimits& limits, const RangeImage& image,
                             std::span<const Vec3f> normals_in_sensor, const View& view, QualityReference reference) {
  const RayGrid rays = image.camera.rays();
  const Mat3 rotation = view.world_from_sensor.linear();
  const int columns = image.camera.resolution.columns;
  const bool has_normals = has_any_normal(image, normals_in_sensor);
  IntegrationReport report;
  for (const std::vector<ScanPoint>& band : limits.points()) {
    report.points_in_enclosure += static_cast<std::int64_t>(band.size());
    for (const ScanPoint& point : band) {
      const Vec3f normal_in_sensor =
          normals_in_sensor.empty() ? Vec3f(Vec3f::Zero()) : normals_in_sensor[static_cast<std::size_t>(point.pixel)];
      const Vec3 normal = rotation * normal_in_sensor.cast<double>();
      const bool has_normal = !normal.isZero(0);
      const auto [surface, is_new] = support.add(point.voxel + map.enclosure().min, has_normal || !has_normals);
      if (is_new) ++report.new_occupied;
      if (surface == nullptr || !has_normal) continue;
      const Vec3 towards =
          reference == QualityReference::axis
              ? view.axis()
              : Vec3(
                    ray_direction(rotation, rays.x(point.pixel % columns), rays.y(point.pixel / columns)).normalized());
      surface->add(normal, point_quality(normal, towards));
    }
  }
  return report;
}

}  // namespace

bool rays_are_faster(const VoxelMap& map, const RangeCamera& camera, const View& view) {
  const double depth_of_center = view.axis().dot(map.enclosure_center() - view.position());
  if (depth_of_center > LatticeProjection::dense_depth(map.grid(), camera)) return true;
  const double widest = std::max({-camera.left, camera.right, -camera.top, camera.bottom});
  const double reach = (2 + widest) * map.grid().length;
  return map.grid().box(map.enclosure()).exteriorDistance(view.position()) < reach;
}

std::int64_t Integrator::look_through(VoxelMap& map, const RangeCamera& camera, const View& view,
                                      const StepCounts& steps) const {
  LookThrough looker(map, camera, view, steps, limits_, projection_);
  const int layers = (map.layout().size.z() + LookThrough::side - 1) / LookThrough::side;
  std::vector<int> emptied(static_cast<std::size_t>(layers));
  parallel_for(emptied.size(), [&](std::size_t layer) {
    emptied[layer] = looker.count_layer(LookThrough::side * static_cast<int>(layer));
  });
  return std::accumulate(emptied.begin(), emptied.end(), std::int64_t{0});
}

IntegrationReport Integrator::integrate(VoxelMap& map, const RangeImage& image,
                                        std::span<const Vec3f> normals_in_sensor, const View& view,
                                        QualityReference reference) {
  image.validate();
  require(normals_in_sensor.empty() || normals_in_sensor.size() == image.depth.size(),
          "integrate: ", normals_in_sensor.size(), " normals for ", image.depth.size(), " pixels");
  require_near(map.grid(), view.position());
  const StepCounts steps(map.layout().size, map.grid().index_of(view.position()) - map.enclosure().min);
  if (steps.span > StepCounts::largest_span || rays_are_faster(map, image.camera, view)) {
    return integrate_exactly(map, sight_lines(image, normals_in_sensor, view, reference));
  }
  projection_.prepare(map.grid(), map.enclosure(), image.camera, view);
  limits_.prepare(map, image, view, steps);
  PointSupport support(map);
  IntegrationReport report = add_points(map, support, limits_, image, normals_in_sensor, view, reference);
  if (map.rule() == MapRule::evidence) report.taken_back = look_through(map, image.camera, view, steps);
  BlockCarver carver(map, image, view, steps, limits_, projection_);
  const int layers = (map.layout().size.z() + block_side - 1) / block_side;
  parallel_for(static_cast<std::size_t>(layers),
               [&](std::size_t layer) { carver.carve_layer(block_side * static_cast<int>(layer)); });
  support.finish();
  map.update_occplane();
  return report;
}

}  // namespace vantage
