#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/visibility/batch_view.hpp"
#include "vantage/visibility/exposed_voxels.hpp"
#include "vantage/visibility/facing.hpp"
#include "vantage/visibility/footprint.hpp"
#include "vantage/visibility/surface_normals.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage {
namespace {

/// Memory that one thread uses for one view after the other.
struct Scratch {
  Coverage coverage;
  std::vector<std::uint32_t> candidates, visible;  // packed voxels
};

/// One view's way through the voxels.
struct Pass {
  PixelFrame frame;
  Coverage& coverage;
  BatchView batch;

  Pass(const PixelFrame& pixel_frame, Coverage& pixels) : frame(pixel_frame), coverage(pixels) {
    batch = batch_view(frame, coverage);
    batch.context = this;
    batch.splat_one = [](const void* pass, std::uint32_t voxel) {
      const auto* self = static_cast<const Pass*>(pass);
      return splat(self->frame, PackedVoxel{voxel}.index(), self->coverage);
    };
  }
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;
};

/// Rays begin in voxels that touch the camera, or that meet the near plane; these may be visible without an empty
/// neighbour. nullopt where none of them lies in the enclosure.
std::optional<FirstVoxels> first_voxels(const PixelFrame& frame) {
  const Index3 last = frame.enclosure.size() - Index3::Ones();
  const Index3 cell = frame.local_cell();
  FirstVoxels first;
  first.gradient.setZero();
  if (frame.near == 0) {
    first.box = {(cell - Index3::Ones()).cwiseMax(0), cell.cwiseMin(last)};
    if ((first.box.min.array() > first.box.max.array()).any()) return std::nullopt;
    return first;
  }
  first.box = {Index3::Zero(), last};
  first.gradient = frame.pixel_from_offset.row(2).transpose();
  first.offset = first.gradient.dot(frame.center(Index3::Zero())) - frame.near / frame.grid.length;
  const double reach = first.gradient.cwiseAbs().dot(last.cast<double>());
  const double middle = first.offset + 0.5 * first.gradient.dot(last.cast<double>());
  first.limit = frame.half_extent.z() + 1e-6 * (1 + reach + std::abs(middle));
  if (std::abs(middle) > 0.5 * reach + first.limit) return std::nullopt;
  return first;
}

/// A region in slices along z, front to back, of bounded numbers of voxels: so the candidates of any map fit in memory.
std::vector<Region> slices(const Region& region) {
  constexpr int largest_slice = 1 << 20;
  const Index3 size = region.box.size();
  const int thickness = std::max(1, largest_slice / (size.x() * size.y()));
  std::vector<Region> found;
  for (int done = 0; done < size.z(); done += thickness) {
    const int more = std::min(thickness, size.z() - done);
    Region slice = region;
    if (region.side_of(2) < 0) {
      slice.box.max.z() = region.box.max.z() - done;
      slice.box.min.z() = slice.box.max.z() - more + 1;
    } else {
      slice.box.min.z() = region.box.min.z() + done;
      slice.box.max.z() = slice.box.min.z() + more - 1;
    }
    found.push_back(slice);
  }
  return found;
}

void require_fit(std::span<const View> views, std::span<const Resolution> resolutions) {
  require(resolutions.size() == 1 || resolutions.size() == views.size(), "see: ", resolutions.size(),
          " resolutions for ", views.size(), " views; must be one, or one per view");
}

}  // namespace

struct VisibilityEvaluator::Prepared {
  Prepared(const VoxelMap& voxel_map, InstructionSet instructions)
      : map(voxel_map), kernels(splat_kernels_for(instructions)), exposed(voxel_map), normals(voxel_map) {}

  const VoxelMap& map;
  SplatKernels kernels;
  ExposedVoxels exposed;
  SurfaceNormals normals;
  mutable tbb::enumerable_thread_specific<Scratch> scratch;

  /// The voxels that end rays, fast; nullptr where only rays can tell.
  [[nodiscard]] const std::vector<std::uint32_t>* splat_view(const RangeCamera& camera, const View& view,
                                                             Resolution resolution) const;
  void splat_region(const Pass& pass, const Region& region, const FirstVoxels* first, Scratch& memory) const;
  void splat_all(const Pass& pass, const BatchRegion& region, std::span<const std::uint32_t> candidates,
                 Scratch& memory) const;
  /// Leaves out the occupied voxels beyond the incidence limit.
  [[nodiscard]] bool counts(const PackedVoxel& voxel, const RangeCamera& camera, const Vec3& axis) const;
  [[nodiscard]] Visibility tally(const std::vector<std::uint32_t>& voxels, const RangeCamera& camera,
                                 const Vec3& axis) const;
};

void VisibilityEvaluator::Prepared::splat_all(const Pass& pass, const BatchRegion& region,
                                              std::span<const std::uint32_t> candidates, Scratch& memory) const {
  const std::size_t before = memory.visible.size();
  memory.visible.resize(before + candidates.size());
  const std::size_t seen =
      kernels.splat(pass.batch, region, candidates.data(), candidates.size(), memory.visible.data() + before);
  memory.visible.resize(before + seen);
}

void VisibilityEvaluator::Prepared::splat_region(const Pass& pass, const Region& region, const FirstVoxels* first,
                                                 Scratch& memory) const {
  const BatchRegion batch = batch_region(pass.frame, region);
  const std::vector<std::uint32_t>* octant = first ? nullptr : exposed.octant(region.side);
  if (!octant) {
    for (const Region& slice : slices(region)) {
      memory.candidates.clear();
      exposed.collect(slice, first, memory.candidates);
      splat_all(pass, batch, memory.candidates, memory);
    }
  } else if (region.box.size() == map.layout().size) {
    splat_all(pass, batch, *octant, memory);
  } else {
    constexpr std::size_t room = 16;
    memory.candidates.resize(octant->size() + room);
    const std::size_t inside = kernels.select(batch, octant->data(), octant->size(), memory.candidates.data());
    splat_all(pass, batch, std::span(memory.candidates.data(), inside), memory);
  }
}

const std::vector<std::uint32_t>* VisibilityEvaluator::Prepared::splat_view(const RangeCamera& camera, const View& view,
                                                                            Resolution resolution) const {
  const PixelFrame frame(map.grid(), map.enclosure(), camera, view, resolution);
  if (!frame.is_regular() || map.layout().size.maxCoeff() > PackedVoxel::max_side) return nullptr;
  Scratch& memory = scratch.local();
  memory.coverage.reset(resolution);
  memory.visible.clear();
  const Pass pass(frame, memory.coverage);
  const std::optional<FirstVoxels> first = first_voxels(frame);
  for (const Region& region : regions_front_to_back(map.layout().size, frame.local_cell())) {
    splat_region(pass, region, first ? &*first : nullptr, memory);
  }
  return &memory.visible;
}

bool VisibilityEvaluator::Prepared::counts(const PackedVoxel& voxel, const RangeCamera& camera,
                                           const Vec3& axis) const {
  if (!camera.max_incidence || voxel.kind() != PackedVoxel::occupied) return true;
  const Vec3& normal = normals[voxel.index()];
  return normal.isZero(0) || !(facing_cosine(axis, normal) < std::cos(*camera.max_incidence));
}

Visibility VisibilityEvaluator::Prepared::tally(const std::vector<std::uint32_t>& voxels, const RangeCamera& camera,
                                                const Vec3& axis) const {
  constexpr double no_limit = -2;
  const double min_cosine = camera.max_incidence ? std::cos(*camera.max_incidence) : no_limit;
  const BatchTally sum =
      kernels.tally(normals.table(), {axis.x(), axis.y(), axis.z()}, min_cosine, voxels.data(), voxels.size());
  const auto count = [&](PackedVoxel::Kind kind) { return static_cast<std::int32_t>(sum.kinds[kind]); };
  Visibility seen;
  seen.occupied = count(PackedVoxel::occupied);
  seen.occplane = count(PackedVoxel::occplane);
  seen.unmarked = count(PackedVoxel::unmarked);
  seen.occluded = count(PackedVoxel::occluded);
  seen.cosine_sum = sum.cosine_sum;
  return seen;
}

VisibilityEvaluator::VisibilityEvaluator(const VoxelMap& map)
    : VisibilityEvaluator(map, available_instruction_sets().back()) {}
VisibilityEvaluator::VisibilityEvaluator(const VoxelMap& map, InstructionSet instructions)
    : prepared_(std::make_unique<const Prepared>(map, instructions)) {}
VisibilityEvaluator::~VisibilityEvaluator() = default;
VisibilityEvaluator::VisibilityEvaluator(VisibilityEvaluator&&) noexcept = default;
VisibilityEvaluator& VisibilityEvaluator::operator=(VisibilityEvaluator&&) noexcept = default;

Visibility VisibilityEvaluator::see(const RangeCamera& camera, const View& view, Resolution resolution) const {
  const std::vector<std::uint32_t>* voxels = prepared_->splat_view(camera, view, resolution);
  if (!voxels) return see_exactly(prepared_->map, camera, view, resolution);
  Visibility seen = prepared_->tally(*voxels, camera, view.axis());
  seen.rays = resolution.rays();
  return seen;
}

std::vector<Index3> VisibilityEvaluator::visible_voxels(const RangeCamera& camera, const View& view,
                                                        Resolution resolution) const {
  const std::vector<std::uint32_t>* voxels = prepared_->splat_view(camera, view, resolution);
  if (!voxels) return visible_voxels_exactly(prepared_->map, camera, view, resolution);
  std::vector<PackedVoxel> counted;
  const Vec3 axis = view.axis();
  for (const std::uint32_t voxel : *voxels) {
    if (prepared_->counts({voxel}, camera, axis)) counted.push_back({voxel});
  }
  std::sort(counted.begin(), counted.end(), [](PackedVoxel a, PackedVoxel b) { return a.place() < b.place(); });
  std::vector<Index3> indices;
  indices.reserve(counted.size());
  for (const PackedVoxel& voxel : counted) indices.emplace_back(prepared_->map.enclosure().min + voxel.index());
  return indices;
}

std::vector<Visibility> VisibilityEvaluator::see(const RangeCamera& camera, std::span<const View> views,
                                                 std::span<const Resolution> resolutions) const {
  require_fit(views, resolutions);
  std::vector<Visibility> seen(views.size());
  parallel_for(views.size(),
               [&](std::size_t i) { seen[i] = see(camera, views[i], resolutions[resolutions.size() == 1 ? 0 : i]); });
  return seen;
}

std::vector<std::optional<Visibility>> VisibilityEvaluator::see_until(std::chrono::steady_clock::time_point deadline,
                                                                      const RangeCamera& camera,
                                                                      std::span<const View> views,
                                                                      std::span<const Resolution> resolutions,
                                                                      std::span<const std::size_t> order) const {
  require_fit(views, resolutions);
  for (const std::size_t i : order) {
    require(i < views.size(), "see_until: order names view ", i, " of ", views.size(), " views");
  }
  std::vector<std::optional<Visibility>> seen(views.size());
  std::atomic<std::size_t> next = 0;  // threads take views in the given order, whichever loop index they run
  parallel_for(order.size(), [&](std::size_t) {
    const std::size_t i = order[next++];
    if (std::chrono::steady_clock::now() >= deadline) return;
    seen[i] = see(camera, views[i], resolutions[resolutions.size() == 1 ? 0 : i]);
  });
  return seen;
}

}  // namespace vantage
