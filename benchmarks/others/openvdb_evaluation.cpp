// The same views by OpenVDB: rays step through the nodes of its tree and, in leaves, through voxels
// (VolumeRayIntersector and DDA, the library's own way to meet the first active voxel). Only the casting is timed, not
// the making of the tree.
#include <openvdb/math/DDA.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/RayIntersector.h>

#include <algorithm>
#include <cmath>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage::bench {
namespace {

using Ray = openvdb::math::Ray<double>;
using Intersector = openvdb::tools::VolumeRayIntersector<openvdb::BoolGrid, 0, Ray>;

/// All non-empty voxels of the enclosure as active ones, with its lowest corner as the origin.
openvdb::BoolGrid::Ptr grid_of(const VoxelMap& map) {
  openvdb::initialize();
  openvdb::BoolGrid::Ptr grid = openvdb::BoolGrid::create(false);
  openvdb::BoolGrid::Accessor voxels = grid->getAccessor();
  const IndexBox& box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        if (map.label({x, y, z}) == Label::empty) continue;
        voxels.setValue(openvdb::Coord(x - box.min.x(), y - box.min.y(), z - box.min.z()), true);
      }
    }
  }
  return grid;
}

openvdb::Vec3d to_openvdb(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Marks the voxels that a view meets first, x fastest; returns how many they are.
class SeenVoxels {
 public:
  explicit SeenVoxels(const VoxelMap& map)
      : map_(map), grid_(grid_of(map)), intersector_(*grid_), voxels_(grid_->getConstAccessor()) {}

  std::size_t count(const RangeCamera& camera, const View& view) {
    const Index3 size = map_.enclosure().size();
    is_seen_.assign(static_cast<std::size_t>(size.prod()), 0);
    const RayGrid rays = camera.rays();
    const Vec3 origin = (view.position() - map_.grid().corner(map_.enclosure().min)) / map_.grid().length;
    for (int row = 0; row < camera.resolution.rows; ++row) {
      for (int column = 0; column < camera.resolution.columns; ++column) {
        const Vec3 d = ray_direction(view.world_from_sensor.linear(), rays.x(column), rays.y(row));
        mark_first({to_openvdb(origin), to_openvdb(d), camera.min_depth, camera.max_depth / map_.grid().length}, size);
      }
    }
    return static_cast<std::size_t>(std::count(is_seen_.begin(), is_seen_.end(), 1));
  }

 private:
  void mark_first(const Ray& ray, const Index3& size) {
    if (!intersector_.setIndexRay(ray)) return;
    double from = 0;
    double to = 0;
    while (intersector_.march(from, to)) {
      openvdb::math::DDA<Ray> voxel(ray, from, to);
      do {
        const openvdb::Coord at = voxel.voxel();
        if (!voxels_.isValueOn(at)) continue;
        is_seen_[static_cast<std::size_t>((at.z() * size.y() + at.y()) * size.x() + at.x())] = 1;
        return;
      } while (voxel.step());
    }
  }

  const VoxelMap& map_;
  openvdb::BoolGrid::Ptr grid_;
  Intersector intersector_;
  openvdb::BoolGrid::ConstAccessor voxels_;
  std::vector<std::uint8_t> is_seen_;
};

void evaluation_openvdb(benchmark::State& state) {
  const VoxelMap& map = map_after_scans(static_cast<int>(state.range(0)));
  const auto side = static_cast<int>(state.range(1));
  const RangeCamera camera = paper_camera({side, side});
  const std::vector<View> views = view_sphere(80, 2, Vec3::Zero()).views;
  SeenVoxels seen(map);
  for (auto _ : state) {
    for (const View& view : views) benchmark::DoNotOptimize(seen.count(camera, view));
  }
  // It breaks ties its own way, so that single voxels may differ; more would mean that it does another job.
  const std::size_t exact = visible_voxels_exactly(map, camera, views[0], camera.resolution).size();
  const auto here = static_cast<double>(seen.count(camera, views[0]));
  state.counters["of_exact"] = here / static_cast<double>(exact);
  if (std::abs(here / static_cast<double>(exact) - 1) > 0.01) state.SkipWithError("sees other voxels than exact rays");
}

BENCHMARK(evaluation_openvdb)
    ->ArgNames({"scans", "side"})
    ->Args({4, 320})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace vantage::bench
