#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/view.hpp"
#include "vantage/visibility/instruction_set.hpp"

namespace vantage {

/// Surfaces seen edge-on are thinner than their voxels: rays often get past them. A ray may once pass an occupied voxel
/// whose normal n has |n.axis| below this; 0: none.
struct GrazingPass {
  double cosine = 0.3;

  void validate() const;
};

/// The distinct voxels that a view's rays meet: occupied ones, also those that a ray passes, and the first unknown one
/// (unmarked, occluded or occplane) of every ray. Both sorted with x fastest, scene indices. An occupied voxel beyond
/// the camera's incidence limit hides what is behind it and is left out.
struct Sight {
  std::vector<Index3> occupied, unknown;

  bool operator==(const Sight&) const = default;
};

/// By exact rays: the definition.
[[nodiscard]] Sight see_past_grazing_exactly(const VoxelMap& map, const RangeCamera& camera, const View& view,
                                             Resolution resolution, const GrazingPass& pass = {});

/// The same for many views of one state of the map, by splatting voxels front to back into two layers: rays that have
/// ended, and rays that have passed one grazing voxel. The map must outlive the evaluator and not change meanwhile.
class SightEvaluator {
 public:
  explicit SightEvaluator(const VoxelMap& map, const GrazingPass& pass = {});
  SightEvaluator(const VoxelMap& map, const GrazingPass& pass, InstructionSet instructions);
  ~SightEvaluator();
  SightEvaluator(SightEvaluator&&) noexcept;
  SightEvaluator& operator=(SightEvaluator&&) noexcept;

  /// Safe to call from several threads.
  [[nodiscard]] Sight see(const RangeCamera& camera, const View& view, Resolution resolution) const;
  /// The same with less work: the number of occupied voxels, and the unknown ones by their places in the enclosure
  /// (voxel_place.hpp), each once, in no particular order.
  struct PackedSight {
    std::int64_t occupied = 0;
    std::vector<std::uint32_t> unknown;
  };
  [[nodiscard]] PackedSight see_packed(const RangeCamera& camera, const View& view, Resolution resolution) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace vantage
