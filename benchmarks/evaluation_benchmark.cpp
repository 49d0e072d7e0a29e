// Evaluation of candidate views: the evaluator against Bresenham and exact rays from the sensor.
#include <tbb/global_control.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <tuple>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage::bench {
namespace {

/// What is evaluated: 80 views of the paper's sphere, with side x side rays each.
struct Job {
  const VoxelMap& map;
  RangeCamera camera;
  std::vector<View> views = view_sphere(80, 2, Vec3::Zero()).views;

  explicit Job(const benchmark::State& state)
      : map(map_after_scans(static_cast<int>(state.range(0)))),
        camera(paper_camera({static_cast<int>(state.range(1)), static_cast<int>(state.range(1))})) {}
};

/// Prepared again every time, as the planner does after every scan.
std::vector<Visibility> by_evaluator(const Job& job) {
  return VisibilityEvaluator(job.map).see(job.camera, job.views, std::span(&job.camera.resolution, 1));
}

template <class SeeOne>
std::vector<Visibility> one_by_one(const Job& job, const SeeOne& see_one) {
  std::vector<Visibility> seen;
  seen.reserve(job.views.size());
  for (const View& view : job.views) seen.push_back(see_one(job.map, job.camera, view, job.camera.resolution));
  return seen;
}

/// Voxels that only one of the evaluator and the exact rays sees, and views whose counts differ.
std::int64_t differing(const Job& job) {
  const VisibilityEvaluator evaluator(job.map);
  std::int64_t sum = 0;
  for (const View& view : job.views) {
    const Resolution rays = job.camera.resolution;
    const std::vector<Index3> fast = evaluator.visible_voxels(job.camera, view, rays);
    const std::vector<Index3> exact = visible_voxels_exactly(job.map, job.camera, view, rays);
    std::vector<Index3> differences;
    std::set_symmetric_difference(fast.begin(), fast.end(), exact.begin(), exact.end(), std::back_inserter(differences),
                                  [](const Index3& a, const Index3& b) {
                                    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
                                  });
    sum += static_cast<std::int64_t>(differences.size());
    sum += evaluator.see(job.camera, view, rays) != see_exactly(job.map, job.camera, view, rays);
  }
  return sum;
}

/// Compared once per row, not at each repetition.
std::int64_t differing_once(const benchmark::State& state) {
  static std::map<std::tuple<std::int64_t, std::int64_t>, std::int64_t> found;
  const std::tuple key{state.range(0), state.range(1)};
  if (!found.contains(key)) found[key] = differing(Job(state));
  return found[key];
}

void evaluation_fast(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Job job(state);
  for (auto _ : state) benchmark::DoNotOptimize(by_evaluator(job));
  report_differing(state, differing_once(state));
}

void evaluation_exact(benchmark::State& state) {
  const Job job(state);
  for (auto _ : state) benchmark::DoNotOptimize(one_by_one(job, see_exactly));
}

void evaluation_bresenham(benchmark::State& state) {
  const Job job(state);
  for (auto _ : state) benchmark::DoNotOptimize(one_by_one(job, see_by_bresenham));
}

void rows(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"scans", "side"})->Unit(benchmark::kMillisecond);
  benchmark->Args({1, 320})->Args({4, 320})->Args({4, 79});
}

BENCHMARK(evaluation_fast)->Apply(rows);
BENCHMARK(evaluation_exact)->Apply(rows)->Iterations(1);
BENCHMARK(evaluation_bresenham)->Apply(rows)->Iterations(1);

}  // namespace
}  // namespace vantage::bench
