#include <algorithm>
#include <cmath>

#include "vantage/map/voxel_ray.hpp"
#include "vantage/visibility/facing.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage {
namespace {

/// Turned from the sensor by more than the incidence limit. Voxels without a normal pass.
bool beyond_incidence(const VoxelMap& map, const Index3& voxel, const Vec3& axis, double min_cosine) {
  const Vec3 normal = map.surface(voxel)->normal();
  return !normal.isZero(0) && facing_cosine(axis, normal) < min_cosine;
}

/// Tells voxels that end rays, at one look-up per voxel.
class EmptyVoxels {
 public:
  explicit EmptyVoxels(const VoxelMap& map)
      : layout_(map.layout()), min_(map.enclosure().min), words_(map.empty().words.data()) {}

  [[nodiscard]] bool contains(const Index3& voxel) const {
    const Index3 local = voxel - min_;
    const bool is_inside = (local.array() >= 0).all() && (local.array() < layout_.size.array()).all();
    return !is_inside || (words_[layout_.word(local)] & BitLayout::bit(local)) != 0;
  }

 private:
  BitLayout layout_;
  Index3 min_;
  const std::uint64_t* words_;
};

/// Voxels that end rays, each once.
class EndVoxels {
 public:
  explicit EndVoxels(const VoxelMap& map) : map_(map) { plane_.words.assign(map.layout().words(), 0); }

  void add(const Index3& voxel) {
    const Index3 local = voxel - map_.enclosure().min;
    std::uint64_t& word = plane_.words[map_.layout().word(local)];
    if ((word & BitLayout::bit(local)) == 0) voxels_.push_back(voxel);
    word |= BitLayout::bit(local);
  }

  [[nodiscard]] std::vector<Index3> sorted(const RangeCamera& camera, const Vec3& axis) && {
    if (camera.max_incidence) {
      const double min_cosine = std::cos(*camera.max_incidence);
      std::erase_if(voxels_, [&](const Index3& v) {
        return map_.label(v) == Label::occupied && beyond_incidence(map_, v, axis, min_cosine);
      });
    }
    std::sort(voxels_.begin(), voxels_.end(), [](const Index3& a, const Index3& b) {
      return std::tie(a.z(), a.y(), a.x()) < std::tie(b.z(), b.y(), b.x());
    });
    return std::move(voxels_);
  }

 private:
  const VoxelMap& map_;
  BitPlane plane_;
  std::vector<Index3> voxels_;
};

Visibility count(const VoxelMap& map, const std::vector<Index3>& voxels, const Vec3& axis, Resolution resolution) {
  Visibility seen;
  seen.rays = resolution.rays();
  for (const Index3& voxel : voxels) count_voxel(seen, map, voxel, axis);
  return seen;
}

}  // namespace

void count_voxel(Visibility& seen, const VoxelMap& map, const Index3& voxel, const Vec3& axis) {
  switch (map.label(voxel)) {
    case Label::occupied:
      ++seen.occupied;
      seen.cosine_sum += to_fixed_point(std::max(0.0, facing_cosine(axis, map.surface(voxel)->normal())));
      break;
    case Label::occplane:
      ++seen.occplane;
      break;
    case Label::unmarked:
      ++seen.unmarked;
      break;
    case Label::occluded:
      ++seen.occluded;
      break;
    case Label::empty:
      break;
  }
}

std::vector<Index3> visible_voxels_exactly(const VoxelMap& map, const RangeCamera& camera, const View& view,
                                           Resolution resolution) {
  const RayGrid rays = camera.rays(resolution);
  const Mat3 rotation = view.world_from_sensor.linear();
  const EmptyVoxels empty(map);
  EndVoxels ends(map);
  for (int row = 0; row < resolution.rows; ++row) {
    for (int column = 0; column < resolution.columns; ++column) {
      const LatticeRay ray(map.grid(), view.position(), ray_direction(rotation, rays.x(column), rays.y(row)));
      visit_voxels(map.grid(), map.enclosure(), ray, camera.min_depth, [&](const Index3& voxel, double entered) {
        if (entered > camera.max_depth) return false;
        if (empty.contains(voxel)) return true;
        ends.add(voxel);
        return false;
      });
    }
  }
  return std::move(ends).sorted(camera, view.axis());
}

Visibility see_exactly(const VoxelMap& map, const RangeCamera& camera, const View& view, Resolution resolution) {
  return count(map, visible_voxels_exactly(map, camera, view, resolution), view.axis(), resolution);
}

Visibility see_by_bresenham(const VoxelMap& map, const RangeCamera& camera, const View& view, Resolution resolution) {
  const RayGrid rays = camera.rays(resolution);
  const Mat3 rotation = view.world_from_sensor.linear();
  const EmptyVoxels empty(map);
  EndVoxels ends(map);
  for (int row = 0; row < resolution.rows; ++row) {
    for (int column = 0; column < resolution.columns; ++column) {
      const Vec3 direction = ray_direction(rotation, rays.x(column), rays.y(row));
      const Index3 from = map.grid().index_of(Vec3(view.position() + camera.min_depth * direction));
      const Index3 to = map.grid().index_of(Vec3(view.position() + camera.max_depth * direction));
      visit_bresenham(from, to, [&](const Index3& voxel) {
        if (empty.contains(voxel)) return true;
        ends.add(voxel);
        return false;
      });
    }
  }
  return count(map, std::move(ends).sorted(camera, view.axis()), view.axis(), resolution);
}

}  // namespace vantage
