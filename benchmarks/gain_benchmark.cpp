// A whole plan by `gain` against one by the combined utility: 80 views, exhaustive, 320 x 320 rays, prepared again as
// after every scan.
#include <tbb/global_control.h>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/planning/planner.hpp"

namespace vantage::bench {
namespace {

void plan_with(benchmark::State& state, const char* utility) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto scans = static_cast<std::size_t>(state.range(0));
  const VoxelMap& map = map_after_scans(static_cast<int>(scans));
  PlannerOptions options;
  options.utility = utility;
  Planner planner(view_sphere(80, 2, Vec3::Zero()), paper_camera(), options);
  for (std::size_t i = 0; i < scans; ++i) planner.scanned(scan_views()[i], -1);
  for (auto _ : state) benchmark::DoNotOptimize(planner.next_best_view(map, scan_views()[scans - 1]));
}

void plan_combined(benchmark::State& state) { plan_with(state, "combined"); }
void plan_gain(benchmark::State& state) { plan_with(state, "gain"); }

void rows(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("scans")->DenseRange(1, 4)->Unit(benchmark::kMillisecond);
}

BENCHMARK(plan_combined)->Apply(rows);
BENCHMARK(plan_gain)->Apply(rows);

}  // namespace
}  // namespace vantage::bench
