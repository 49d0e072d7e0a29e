#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

/// What all benchmarks share: a mug, its scans, and the map after some of them.
namespace vantage::bench {

/// Edges of the scene and of its enclosure in voxels, for the paper's 4.1 m with 1.1 m (spec, section 9).
struct SceneSize {
  int scene = 205, enclosure = 55;
};
inline constexpr SceneSize paper_scene{205, 55};
inline constexpr SceneSize finest_scene{405, 109};

[[nodiscard]] SceneOptions scene_options(SceneSize size);

/// The paper's camera: 45 x 45 degrees.
[[nodiscard]] RangeCamera paper_camera(Resolution resolution = {320, 320});

/// One scan of the mug.
struct Scan {
  RangeImage image;
  std::vector<Vec3f> normals;  // in the sensor frame
  View view;
};

/// A noise-free scan of a mug of 0.8 m (a hollow cylinder with a handle, by sphere tracing its distance function).
[[nodiscard]] Scan scan_of_mug(const RangeCamera& camera, const View& view);

/// Four places 2 m from the centre, one on each side and one above.
[[nodiscard]] std::vector<View> scan_views();

/// The map after the first `scans` scans from scan_views(), each 320 x 320. Computed once per program.
[[nodiscard]] const VoxelMap& map_after_scans(int scans, SceneSize size = paper_scene);

/// Puts the number of voxels (or counts) that differ from the reference into the row; anything but 0 fails the run.
void report_differing(benchmark::State& state, std::int64_t differing);

}  // namespace vantage::bench
