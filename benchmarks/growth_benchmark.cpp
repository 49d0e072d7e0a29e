// How evaluation grows with views, rays and voxels, and with threads; and table 3's largest case, against the
// multi-resolution search by Bresenham.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/search/search.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage::bench {
namespace {

std::vector<View> sphere(int views) { return view_sphere(views, 2, Vec3::Zero()).views; }

std::vector<Visibility> evaluate(const VoxelMap& map, const RangeCamera& camera, const std::vector<View>& views) {
  return VisibilityEvaluator(map).see(camera, views, std::span(&camera.resolution, 1));
}

void run(benchmark::State& state, const VoxelMap& map, int side, int views, int threads = 1) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const RangeCamera camera = paper_camera({side, side});
  const std::vector<View> candidates = sphere(views);
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(map, camera, candidates));
}

void growth_with_views(benchmark::State& state) {
  run(state, map_after_scans(4), 320, static_cast<int>(state.range(0)));
}
void growth_with_rays(benchmark::State& state) { run(state, map_after_scans(4), static_cast<int>(state.range(0)), 80); }
/// Table 3's scenes and one beyond: the enclosure keeps its 1.1 m.
void growth_with_voxels(benchmark::State& state) {
  const SceneSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  run(state, map_after_scans(4, size), 320, 80);
}

void finest_exhaustive(benchmark::State& state) { run(state, map_after_scans(1, finest_scene), 320, 1280); }

/// The rays of Algorithm 2 with Bresenham: all views at the lowest resolution, then b^(k-i) after stage i. Which views
/// these are hardly changes the time.
void finest_bresenham_multi_resolution(benchmark::State& state) {
  const VoxelMap& map = map_after_scans(1, finest_scene);
  const RangeCamera camera = paper_camera();
  const std::vector<View> views = sphere(1280);
  const MultiResolutionOptions options;
  const int stages = number_of_stages(1280, options.b);
  const Resolution ideal = ideal_resolution(camera, map.grid().length, 2);
  for (auto _ : state) {
    std::size_t count = views.size();
    for (int stage = 1; stage <= stages; ++stage) {
      const Resolution rays = stage_resolution(ideal, options.min_columns, stage, stages);
      for (std::size_t i = 0; i < count; ++i) {
        benchmark::DoNotOptimize(see_by_bresenham(map, camera, views[i], rays));
      }
      count = std::min(count, static_cast<std::size_t>(std::llround(std::pow(options.b, stages - stage))));
    }
  }
}

void evaluation_threads(benchmark::State& state) {
  run(state, map_after_scans(1, finest_scene), 320, 1280, static_cast<int>(state.range(0)));
}

BENCHMARK(finest_exhaustive)->Unit(benchmark::kMillisecond);
BENCHMARK(finest_bresenham_multi_resolution)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(evaluation_threads)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(growth_with_views)->ArgName("views")->Arg(20)->Arg(80)->Arg(320)->Arg(1280)->Unit(benchmark::kMillisecond);
BENCHMARK(growth_with_rays)
    ->ArgName("side")
    ->Arg(40)
    ->Arg(79)
    ->Arg(160)
    ->Arg(320)
    ->Arg(640)
    ->Arg(1280)
    ->Arg(2048)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(growth_with_voxels)
    ->ArgNames({"scene", "enclosure"})
    ->Args({85, 23})
    ->Args({138, 37})
    ->Args({205, 55})
    ->Args({405, 109})
    ->Args({809, 217})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage::bench
