#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/core/fixed_point.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/sight_line.hpp"
#include "vantage/visibility/instruction_set.hpp"

namespace vantage {

/// What a view would see (paper, section 4.2): numbers of distinct voxels that end at least one ray.
struct Visibility {
  std::int64_t rays = 0;
  std::int32_t occupied = 0;    // n_oc
  std::int32_t occplane = 0;    // n_op
  std::int32_t unmarked = 0;    // n_um
  std::int32_t occluded = 0;    // occluded but not occplane; counts in nothing
  std::int64_t cosine_sum = 0;  // sum of max(0, -axis.normal) over the visible occupied voxels, fixed point

  bool operator==(const Visibility&) const = default;
};

/// Adds one visible voxel to the counts of a view that looks along `axis`.
void count_voxel(Visibility& seen, const VoxelMap& map, const Index3& voxel, const Vec3& axis);

/// The voxels that a view sees, by exact rays through all voxels (spec, section 3): the definition that every fast path
/// is tested against. Sorted with x fastest; an occupied voxel beyond the incidence limit ends rays and is left out.
[[nodiscard]] std::vector<Index3> visible_voxels_exactly(const VoxelMap& map, const RangeCamera& camera,
                                                         const View& view, Resolution resolution);
[[nodiscard]] Visibility see_exactly(const VoxelMap& map, const RangeCamera& camera, const View& view,
                                     Resolution resolution);

/// The same by Bresenham lines from the sensor's voxel to the end of the ray, as in the paper. Misses voxels that the
/// exact ray crosses; kept for fidelity and as the benchmark's baseline.
[[nodiscard]] Visibility see_by_bresenham(const VoxelMap& map, const RangeCamera& camera, const View& view,
                                          Resolution resolution);

/// What many views would see of one state of the map; prepared once per map, then shared by all threads. Gives what
/// see_exactly gives, by splatting voxels front to back instead of casting rays (docs/performance.md). The map must
/// outlive the evaluator and not change meanwhile.
class VisibilityEvaluator {
 public:
  explicit VisibilityEvaluator(const VoxelMap& map);
  /// With the given instructions, which must be among the available ones; the results are the same.
  VisibilityEvaluator(const VoxelMap& map, InstructionSet instructions);
  ~VisibilityEvaluator();
  VisibilityEvaluator(VisibilityEvaluator&&) noexcept;
  VisibilityEvaluator& operator=(VisibilityEvaluator&&) noexcept;

  [[nodiscard]] Visibility see(const RangeCamera& camera, const View& view, Resolution resolution) const;
  /// All views at their own resolutions (one, or one per view), in parallel; the same for any number of threads.
  [[nodiscard]] std::vector<Visibility> see(const RangeCamera& camera, std::span<const View> views,
                                            std::span<const Resolution> resolutions) const;
  /// The same, view after view in the given order of indices, until the deadline: no view is begun after it. Views that
  /// were not evaluated are nullopt.
  [[nodiscard]] std::vector<std::optional<Visibility>> see_until(std::chrono::steady_clock::time_point deadline,
                                                                 const RangeCamera& camera, std::span<const View> views,
                                                                 std::span<const Resolution> resolutions,
                                                                 std::span<const std::size_t> order) const;
  /// The voxels that are counted, in scene indices and sorted with x fastest: what visible_voxels_exactly gives.
  [[nodiscard]] std::vector<Index3> visible_voxels(const RangeCamera& camera, const View& view,
                                                   Resolution resolution) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace vantage
