// The view cube of figures 10 and 11: 1,932 views of 320 x 240 rays, and the convolution over them.
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>
#include <span>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/search/convolution.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage::bench {
namespace {

constexpr int sampled = 16;  // Bresenham, at a minute and a half for all views, takes every 16th

RangeCamera cube_camera() { return camera_from_apertures(radians(92.5), radians(72.32), {320, 240}); }
Candidates cube() { return candidates_from_text("cube:17:4.1:0.82:1.9", Vec3::Zero()); }

void cube_fast(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const RangeCamera camera = cube_camera();
  const std::vector<View> views = cube().views;
  const VoxelMap& map = map_after_scans(4);
  std::vector<Visibility> seen;
  for (auto _ : state) seen = VisibilityEvaluator(map).see(camera, views, std::span(&camera.resolution, 1));
  static const std::int64_t differing = [&] {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < views.size(); i += sampled) {
      sum += seen[i] != see_exactly(map, camera, views[i], camera.resolution);
    }
    return sum;
  }();
  report_differing(state, differing);
}

void cube_bresenham_every_16th(benchmark::State& state) {
  const RangeCamera camera = cube_camera();
  const std::vector<View> views = cube().views;
  const VoxelMap& map = map_after_scans(4);
  for (auto _ : state) {
    for (std::size_t i = 0; i < views.size(); i += sampled) {
      benchmark::DoNotOptimize(see_by_bresenham(map, camera, views[i], camera.resolution));
    }
  }
}

PositioningError error() { return PositioningError::from_deviations(Vec3::Constant(0.1)); }

/// Any values that differ from view to view.
std::vector<double> utilities_of(const Candidates& candidates) {
  std::vector<double> utilities;
  for (const View& view : candidates.views) utilities.push_back(1 + std::sin(5 * view.position().sum()));
  return utilities;
}

/// Eq. 20 as it is written: a sum over all views for every view.
std::vector<double> convolve_directly(const std::vector<double>& utilities, const Candidates& candidates) {
  const ErrorDensity density(error(), 1e-3 * candidates.grid->spacing);
  std::vector<double> expected(utilities.size(), 0.0);
  for (std::size_t v = 0; v < utilities.size(); ++v) {
    for (std::size_t m = 0; m < utilities.size(); ++m) {
      expected[v] += density(candidates.views[m].position() - candidates.views[v].position()) * utilities[m];
    }
  }
  return expected;
}

void convolution_separable(benchmark::State& state) {
  const Candidates candidates = cube();
  const std::vector<double> utilities = utilities_of(candidates);
  std::vector<double> expected;
  for (auto _ : state) benchmark::DoNotOptimize(expected = convolve(utilities, candidates, error()));
  const std::vector<double> directly = convolve_directly(utilities, candidates);
  std::int64_t differing = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    differing += std::abs(expected[i] - directly[i]) > 1e-12 * std::abs(directly[i]) ? 1 : 0;
  }
  report_differing(state, differing);
}

void convolution_direct(benchmark::State& state) {
  const Candidates candidates = cube();
  const std::vector<double> utilities = utilities_of(candidates);
  for (auto _ : state) benchmark::DoNotOptimize(convolve_directly(utilities, candidates));
}

BENCHMARK(cube_fast)->Unit(benchmark::kMillisecond);
BENCHMARK(cube_bresenham_every_16th)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(convolution_separable)->Unit(benchmark::kMillisecond);
BENCHMARK(convolution_direct)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace vantage::bench
