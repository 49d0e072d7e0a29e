#include "vantage/map/look_through.hpp"

#include <algorithm>
#include <bit>

#include "vantage/map/voxel_ray.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {

static_assert(64 % LookThrough::side == 0, "a block's row lies in one word");

LookThrough::LookThrough(VoxelMap& map, const RangeCamera& camera, const View& view, const StepCounts& steps,
                         const ScanLimits& limits, const LatticeProjection& projection)
    : map_(map),
      near_(camera.min_depth),
      rays_(camera.rays()),
      rotation_(view.world_from_sensor.linear()),
      eye_(view.position()),
      steps_(steps),
      limits_(limits),
      projection_(projection) {}

int LookThrough::count_layer(int z) {
  const BitLayout& layout = map_.layout();
  const std::vector<std::uint64_t>& touched = map_.touched().words;
  const int end_z = std::min(z + side, layout.size.z());
  int emptied = 0;
  for (int y = 0; y < layout.size.y(); y += side) {
    const int end_y = std::min(y + side, layout.size.y());
    for (int w = 0; w < layout.words_per_row; ++w) {
      std::uint64_t any = 0;
      for (int row_z = z; row_z < end_z; ++row_z) {
        for (int row_y = y; row_y < end_y; ++row_y)
          any |= touched[layout.row(row_y, row_z) + static_cast<std::size_t>(w)];
      }
      while (any != 0) {
        const int first = std::countr_zero(any) / side * side;
        const std::uint64_t columns = ((std::uint64_t{1} << side) - 1) << first;
        any &= ~columns;
        const int x = 64 * w + first;
        emptied += count_block({{x, y, z}, {std::min(x + side, layout.size.x()), end_y, end_z}, columns});
      }
    }
  }
  return emptied;
}

int LookThrough::count_block(const Block& block) {
  using Kind = LatticeProjection::Footprint::Kind;
  const LatticeProjection::Footprint footprint = projection_.footprint(block.low, block.high);
  if (footprint.kind == Kind::none) return 0;
  const LimitRange range = limits_.range(footprint.pixels);
  const auto [least, most] = steps_.range(block.low, block.high);
  if (least + steps_looked_through >= range.most_emptied()) return 0;
  const bool is_dense = projection_.is_dense(footprint);
  const bool is_all_through = is_dense && most + steps_looked_through < range.least_emptied();
  int emptied = 0;
  for (int z = block.low.z(); z < block.high.z(); ++z) {
    for (int y = block.low.y(); y < block.high.y(); ++y) {
      const std::size_t word = map_.layout().word({block.low.x(), y, z});
      const std::uint64_t touched = map_.touched().words[word] & block.columns;
      std::uint64_t through = is_all_through ? touched : 0;
      for (std::uint64_t bits = touched & ~through; bits != 0; bits &= bits - 1) {
        const Index3 voxel((block.low.x() & ~63) + std::countr_zero(bits), y, z);
        if (looks_through(voxel, is_dense)) through |= bits & (~bits + 1);
      }
      if (through != 0) emptied += map_.contradict_word(word, through);
    }
  }
  return emptied;
}

bool LookThrough::passes(const Index3& voxel, int column, int row) const {
  const Index3 origin = map_.enclosure().min;
  const LatticeRay ray(eye_, steps_.eye + origin, ray_direction(rotation_, rays_.x(column), rays_.y(row)));
  return passes_voxel(map_.grid(), ray, voxel + origin, near_, LatticeRay::never);
}

bool LookThrough::looks_through(const Index3& voxel, bool is_dense) const {
  const int least_end = steps_.of(voxel) + steps_looked_through;
  bool is_passed = false;
  if (is_dense) {  // the ray nearest to the centre passes
    const LatticeProjection::Homogeneous twice_center = projection_.corner(voxel.x(), voxel.y(), voxel.z()) +
                                                        projection_.corner(voxel.x() + 1, voxel.y() + 1, voxel.z() + 1);
    const double inverse = 1 / twice_center.w;
    const PixelLimits nearest =
        limits_.at(static_cast<int>(twice_center.u * inverse + 0.5), static_cast<int>(twice_center.v * inverse + 0.5));
    is_passed = nearest.emptied_below != PixelLimits::unknown;
    if (is_passed && nearest.emptied_below <= least_end) return false;
  }
  const PixelRect pixels = projection_.footprint(voxel, voxel + Index3::Ones()).pixels;
  if (pixels.is_empty()) return false;
  const LimitRange range = limits_.range(pixels);
  if (range.most_emptied() <= least_end) return false;
  if (is_passed && range.least_emptied() > least_end) return true;
  for (int row = pixels.top; row <= pixels.bottom; ++row) {
    const PixelLimits* const limits = limits_.row_of(row);
    for (int column = pixels.left; column <= pixels.right; ++column) {
      const int end = limits[column].emptied_below;
      const bool is_through = end > least_end;
      if (end == PixelLimits::unknown || (is_through && is_passed) || !passes(voxel, column, row)) continue;
      if (!is_through) return false;
      is_passed = true;
    }
  }
  return is_passed;
}

}  // namespace vantage
