// The same scans into OctoMap, misses included: its rays free the cells up to each point, and up to the far limit where
// nothing was met.
#include <octomap/octomap.h>

#include "fixtures.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage::bench {
namespace {

octomap::point3d to_octomap(const Vec3& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z())};
}

/// Points of a scan; rays without a return end at the far limit.
octomap::Pointcloud cloud_of(const Scan& scan) {
  octomap::Pointcloud cloud;
  for (const SightLine& line : sight_lines(scan.image, scan.normals, scan.view))
    cloud.push_back(to_octomap(line.hit_point()));
  return cloud;
}

void integration_octomap(benchmark::State& state) {
  const std::vector<View> views = scan_views();
  const auto last = static_cast<std::size_t>(state.range(0)) - 1;
  const RangeCamera camera = paper_camera();
  const auto insert = [&](octomap::OcTree& tree, const octomap::Pointcloud& cloud, const View& view) {
    // Points farther than the limit free their ray up to it and mark nothing.
    tree.insertPointCloud(cloud, to_octomap(view.position()), camera.max_depth);
  };
  octomap::OcTree before(0.02);
  for (std::size_t i = 0; i < last; ++i) insert(before, cloud_of(scan_of_mug(camera, views[i])), views[i]);
  const octomap::Pointcloud cloud = cloud_of(scan_of_mug(camera, views[last]));
  for (auto _ : state) {
    state.PauseTiming();
    octomap::OcTree tree(before);
    state.ResumeTiming();
    insert(tree, cloud, views[last]);
    benchmark::ClobberMemory();
  }
}

BENCHMARK(integration_octomap)->ArgNames({"scan"})->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace vantage::bench
