// Integration of one scan into the map after the scans before it: the integrator against exact rays. Points and normals
// are given.
#include <tbb/global_control.h>

#include <map>

#include "fixtures.hpp"
#include "vantage/map/integrator.hpp"

namespace vantage::bench {
namespace {

/// What is integrated: scan number `scan` (from 1) of the mug with 320 x 320 rays.
struct Job {
  const VoxelMap& before;
  Scan scan;

  explicit Job(const benchmark::State& state)
      : before(map_after_scans(static_cast<int>(state.range(0)) - 1)),
        scan(scan_of_mug(paper_camera(), scan_views()[static_cast<std::size_t>(state.range(0)) - 1])) {}
};

std::int64_t differing_voxels(const VoxelMap& a, const VoxelMap& b) {
  std::int64_t sum = 0;
  const IndexBox& box = a.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Index3 voxel(x, y, z);
        const SurfaceVoxel* const in_a = a.surface(voxel);
        const SurfaceVoxel* const in_b = b.surface(voxel);
        const bool same_surface = in_a == nullptr || in_b == nullptr
                                      ? in_a == in_b
                                      : in_a->normal_sum == in_b->normal_sum && in_a->quality == in_b->quality;
        if (a.label(voxel) != b.label(voxel) || !same_surface) ++sum;
      }
    }
  }
  return sum;
}

/// Compared once per row, not at each repetition.
std::int64_t differing_once(const benchmark::State& state) {
  static std::map<std::int64_t, std::int64_t> found;
  if (!found.contains(state.range(0))) {
    const Job job(state);
    VoxelMap fast = job.before;
    VoxelMap exact = job.before;
    integrate(fast, job.scan.image, job.scan.normals, job.scan.view);
    integrate_exactly(exact, sight_lines(job.scan.image, job.scan.normals, job.scan.view));
    found[state.range(0)] = differing_voxels(fast, exact);
  }
  return found[state.range(0)];
}

/// Times `integrate_into(map)` on a fresh copy of the map each time.
template <class IntegrateInto>
void time_on_copies(benchmark::State& state, const VoxelMap& before, const IntegrateInto& integrate_into) {
  for (auto _ : state) {
    state.PauseTiming();
    VoxelMap map = before;
    state.ResumeTiming();
    integrate_into(map);
    benchmark::ClobberMemory();
  }
}

void integration_fast(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Job job(state);
  Integrator integrator;
  time_on_copies(state, job.before,
                 [&](VoxelMap& map) { integrator.integrate(map, job.scan.image, job.scan.normals, job.scan.view); });
  report_differing(state, differing_once(state));
}

void integration_exact(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Job job(state);
  const std::vector<SightLine> lines = sight_lines(job.scan.image, job.scan.normals, job.scan.view);
  time_on_copies(state, job.before, [&](VoxelMap& map) { integrate_exactly(map, lines); });
}

void range_image_normals_fast(benchmark::State& state) {
  const Scan scan = scan_of_mug(paper_camera(), scan_views()[0]);
  for (auto _ : state) benchmark::DoNotOptimize(range_image_normals(scan.image));
}

void rows(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"scan"})->Unit(benchmark::kMillisecond)->Arg(1)->Arg(4);
}

BENCHMARK(integration_fast)->Apply(rows);
BENCHMARK(integration_exact)->Apply(rows);
BENCHMARK(range_image_normals_fast)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage::bench
