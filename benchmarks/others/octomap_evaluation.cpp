// The same views by OctoMap's castRay from the sensor. Only the casting is timed, not the making of the tree. Its rays
// are in single precision, so that its voxels are not compared.
#include <octomap/octomap.h>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage::bench {
namespace {

octomap::point3d to_octomap(const Vec3& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z())};
}

/// All non-empty voxels as occupied cells, everything else free. OctoMap's lattice has planes at whole multiples of the
/// voxel length, so everything is moved onto it.
octomap::OcTree tree_of(const VoxelMap& map, const Vec3& move) {
  octomap::OcTree tree(map.grid().length);
  const IndexBox& box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const bool is_full = map.label({x, y, z}) != Label::empty;
        tree.updateNode(to_octomap(map.grid().center({x, y, z}) + move), is_full, true);
      }
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

void evaluation_octomap(benchmark::State& state) {
  const VoxelMap& map = map_after_scans(static_cast<int>(state.range(0)));
  const auto side = static_cast<int>(state.range(1));
  const RangeCamera camera = paper_camera({side, side});
  const RayGrid rays = camera.rays();
  const Vec3 move = -map.grid().min;
  const octomap::OcTree tree = tree_of(map, move);
  const std::vector<View> views = view_sphere(80, 2, Vec3::Zero()).views;
  for (auto _ : state) {
    for (const View& view : views) {
      octomap::KeySet seen;
      const octomap::point3d origin = to_octomap(view.position() + move);
      for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
          const Vec3 d = ray_direction(view.world_from_sensor.linear(), rays.x(column), rays.y(row));
          octomap::point3d end;
          if (tree.castRay(origin, to_octomap(d), end, true, camera.max_depth * d.norm()))
            seen.insert(tree.coordToKey(end));
        }
      }
      benchmark::DoNotOptimize(seen.size());
    }
  }
}

BENCHMARK(evaluation_octomap)
    ->ArgNames({"scans", "side"})
    ->Args({4, 320})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->Repetitions(1);

}  // namespace
}  // namespace vantage::bench
