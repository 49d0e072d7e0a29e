#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "vantage/visibility/batch_view.hpp"
#include "vantage/visibility/facing.hpp"
#include "vantage/visibility/footprint.hpp"
#include "vantage/visibility/passable_voxels.hpp"
#include "vantage/visibility/sight.hpp"
#include "vantage/visibility/sight_batch.hpp"
#include "vantage/visibility/surface_normals.hpp"
#include "vantage/visibility/voxel_place.hpp"

namespace vantage {
namespace {

SplatSights splat_sights_for(InstructionSet set) {
#ifdef VANTAGE_X86_64
  if (set == InstructionSet::avx2) return splat_sights_avx2();
  if (set == InstructionSet::avx512) return splat_sights_avx512();
#endif
  (void)set;
  return splat_sights_portable();
}

/// Memory that one thread uses for one view after the other.
struct SightScratch {
  Coverage ended, passed;
  BitPlane grazing, passable, facing;          // grazing voxels, these with the empty ones, PassableVoxels::collect()
  std::vector<std::uint32_t> inside, visible;  // packed voxels
};

/// One view's way through the voxels.
struct SightPass {
  PixelFrame frame;
  SightScratch& memory;
  BitLayout layout;
  BatchView batch;

  SightPass(const PixelFrame& pixel_frame, SightScratch& scratch, const BitLayout& bit_layout)
      : frame(pixel_frame), memory(scratch), layout(bit_layout) {
    batch = batch_view(frame, memory.ended);
    batch.context = this;
    batch.splat_one = [](const void* pass, std::uint32_t voxel) {
      return static_cast<const SightPass*>(pass)->splat_one(PackedVoxel{voxel});
    };
  }
  SightPass(const SightPass&) = delete;
  SightPass& operator=(const SightPass&) = delete;

  [[nodiscard]] GrazingLayer layer() const {
    return {memory.passed.first_strip(), memory.grazing.words.data(), static_cast<std::size_t>(layout.size.y()),
            static_cast<std::size_t>(layout.words_per_row)};
  }
  /// In double precision.
  [[nodiscard]] bool splat_one(PackedVoxel voxel) const {
    const Index3 index = voxel.index();
    const bool is_grazing = (memory.grazing.words[layout.word(index)] & BitLayout::bit(index)) != 0;
    return is_grazing ? splat_once(frame, index, memory.ended, memory.passed) : splat(frame, index, memory.ended);
  }
};

/// Rays that begin in the enclosure, or at the near plane within it, may meet voxels without a passable neighbour.
bool begins_outside(const PixelFrame& frame) {
  const Index3 last = frame.enclosure.size() - Index3::Ones();
  const Index3 cell = frame.local_cell();
  if (((cell.array() >= -1) && (cell.array() <= last.array() + 1)).all()) return false;
  const Vec3 gradient = frame.pixel_from_offset.row(2).transpose();
  const double middle = gradient.dot(frame.center(Index3::Zero())) + 0.5 * gradient.dot(last.cast<double>());
  const double reach = 0.5 * gradient.cwiseAbs().dot(last.cast<double>()) + frame.half_extent.z();
  return frame.near == 0 || middle - reach > frame.near / frame.grid.length * (1 + 1e-6) + 1e-6;
}

}  // namespace

struct SightEvaluator::Prepared {
  Prepared(const VoxelMap& voxel_map, const GrazingPass& grazing, InstructionSet instructions)
      : map(voxel_map), pass(grazing), splat(splat_sights_for(instructions)), normals(voxel_map) {
    pass.validate();
    if (voxel_map.layout().size.maxCoeff() <= PackedVoxel::max_side)
      voxels.emplace(voxel_map, splat_kernels_for(instructions).select);
  }

  const VoxelMap& map;
  GrazingPass pass;
  SplatSights splat;
  SurfaceNormals normals;
  std::optional<PassableVoxels> voxels;  // where the map is small enough to pack them
  mutable tbb::enumerable_thread_specific<SightScratch> scratch;

  /// Occupied voxels that this axis grazes.
  void mark_grazing(SightScratch& memory, const Vec3& axis) const {
    BitPlane& grazing = memory.grazing;
    grazing.words.assign(map.layout().words(), 0);
    memory.passable.words = map.empty().words;
    std::size_t rank = 0;
    const double* normal = normals.table().normals;
    for (std::size_t word = 0; word < grazing.words.size(); ++word) {
      for (std::uint64_t bits = map.occupied().words[word]; bits != 0; bits &= bits - 1, ++rank) {
        const Vec3 n(normal[3 * rank], normal[3 * rank + 1], normal[3 * rank + 2]);
        if (std::abs(facing_cosine(axis, n)) < pass.cosine) grazing.words[word] |= bits & ~(bits - 1);
      }
      memory.passable.words[word] |= grazing.words[word];
    }
  }

  /// Packed voxels that rays meet; nullptr where only rays can tell.
  [[nodiscard]] const std::vector<std::uint32_t>* splat_view(const RangeCamera& camera, const View& view,
                                                             Resolution resolution) const {
    const PixelFrame frame(map.grid(), map.enclosure(), camera, view, resolution);
    if (!voxels || !frame.is_regular() || !begins_outside(frame)) return nullptr;
    SightScratch& memory = scratch.local();
    memory.ended.reset(resolution);
    memory.passed.reset(resolution);
    memory.visible.clear();
    mark_grazing(memory, view.axis());
    const SightPass way(frame, memory, map.layout());
    for (const Region& region : regions_front_to_back(map.layout().size, frame.local_cell())) {
      const BatchRegion batch = batch_region(frame, region);
      memory.inside.clear();
      voxels->collect(memory.passable, region, batch, memory.facing, memory.inside);
      const std::size_t before = memory.visible.size();
      memory.visible.resize(before + memory.inside.size());
      const std::size_t seen = splat(way.batch, way.layer(), batch, memory.inside.data(), memory.inside.size(),
                                     memory.visible.data() + before);
      memory.visible.resize(before + seen);
    }
    return &memory.visible;
  }

  [[nodiscard]] bool counts(PackedVoxel voxel, const RangeCamera& camera, const Vec3& axis) const {
    if (!camera.max_incidence) return true;
    const Vec3& normal = normals[voxel.index()];
    return normal.isZero(0) || !(facing_cosine(axis, normal) < std::cos(*camera.max_incidence));
  }
};

SightEvaluator::SightEvaluator(const VoxelMap& map, const GrazingPass& pass)
    : SightEvaluator(map, pass, available_instruction_sets().back()) {}
SightEvaluator::SightEvaluator(const VoxelMap& map, const GrazingPass& pass, InstructionSet instructions)
    : prepared_(std::make_unique<const Prepared>(map, pass, instructions)) {}
SightEvaluator::~SightEvaluator() = default;
SightEvaluator::SightEvaluator(SightEvaluator&&) noexcept = default;
SightEvaluator& SightEvaluator::operator=(SightEvaluator&&) noexcept = default;

SightEvaluator::PackedSight SightEvaluator::see_packed(const RangeCamera& camera, const View& view,
                                                       Resolution resolution) const {
  PackedSight sight;
  const VoxelMap& map = prepared_->map;
  const BitLayout& layout = map.layout();
  const std::vector<std::uint32_t>* voxels = prepared_->splat_view(camera, view, resolution);
  if (!voxels) {
    const Sight exact = see_past_grazing_exactly(map, camera, view, resolution, prepared_->pass);
    sight.occupied = static_cast<std::int64_t>(exact.occupied.size());
    sight.unknown.reserve(exact.unknown.size());
    for (const Index3& voxel : exact.unknown) sight.unknown.push_back(place_of(layout, voxel - map.enclosure().min));
    return sight;
  }
  const Vec3 axis = view.axis();
  for (const std::uint32_t voxel : *voxels) {
    if (PackedVoxel{voxel}.kind() != PackedVoxel::occupied) {
      sight.unknown.push_back(place_of(layout, PackedVoxel{voxel}.index()));
    } else if (prepared_->counts({voxel}, camera, axis)) {
      ++sight.occupied;
    }
  }
  return sight;
}

Sight SightEvaluator::see(const RangeCamera& camera, const View& view, Resolution resolution) const {
  const std::vector<std::uint32_t>* voxels = prepared_->splat_view(camera, view, resolution);
  if (!voxels) return see_past_grazing_exactly(prepared_->map, camera, view, resolution, prepared_->pass);
  std::vector<std::uint32_t> sorted = *voxels;
  std::sort(sorted.begin(), sorted.end(),
            [](std::uint32_t a, std::uint32_t b) { return PackedVoxel{a}.place() < PackedVoxel{b}.place(); });
  Sight sight;
  const Vec3 axis = view.axis();
  for (const std::uint32_t bits : sorted) {
    const PackedVoxel voxel{bits};
    const Index3 scene = prepared_->map.enclosure().min + voxel.index();
    if (voxel.kind() != PackedVoxel::occupied) {
      sight.unknown.push_back(scene);
    } else if (prepared_->counts(voxel, camera, axis)) {
      sight.occupied.push_back(scene);
    }
  }
  return sight;
}

}  // namespace vantage
