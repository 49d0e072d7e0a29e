#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "vantage/core/error.hpp"
#include "vantage/map/voxel_ray.hpp"
#include "vantage/sensor/sight_line.hpp"
#include "vantage/visibility/facing.hpp"
#include "vantage/visibility/sight.hpp"

namespace vantage {
namespace {

struct XFastest {
  bool operator()(const Index3& a, const Index3& b) const {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
  }
};

}  // namespace

void GrazingPass::validate() const {
  require(cosine >= 0 && cosine <= 1, "grazing cosine = ", cosine, ": must be in [0, 1]");
}

Sight see_past_grazing_exactly(const VoxelMap& map, const RangeCamera& camera, const View& view, Resolution resolution,
                               const GrazingPass& pass) {
  const RayGrid rays = camera.rays(resolution);
  const Mat3 rotation = view.world_from_sensor.linear();
  const Vec3 axis = view.axis();
  std::map<Index3, Label, XFastest> met;
  for (int row = 0; row < resolution.rows; ++row) {
    for (int column = 0; column < resolution.columns; ++column) {
      const LatticeRay ray(map.grid(), view.position(), ray_direction(rotation, rays.x(column), rays.y(row)));
      bool may_pass = true;
      visit_voxels(map.grid(), map.enclosure(), ray, camera.min_depth, [&](const Index3& voxel, double entered) {
        if (entered > camera.max_depth) return false;
        const Label label = map.label(voxel);
        if (label == Label::empty) return true;
        met[voxel] = label;
        if (label != Label::occupied || !may_pass) return false;
        may_pass = false;
        return std::abs(facing_cosine(axis, map.surface(voxel)->normal())) < pass.cosine;
      });
    }
  }
  Sight sight;
  for (const auto& [voxel, label] : met) {
    if (label != Label::occupied) {
      sight.unknown.push_back(voxel);
      continue;
    }
    const Vec3 normal = map.surface(voxel)->normal();
    const bool counts =
        !camera.max_incidence || normal.isZero(0) || !(facing_cosine(axis, normal) < std::cos(*camera.max_incidence));
    if (counts) sight.occupied.push_back(voxel);
  }
  return sight;
}

}  // namespace vantage
