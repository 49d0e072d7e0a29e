#include "vantage/utility/ray_information.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr double most_steps = std::numeric_limits<std::uint16_t>::max();

bool ends_occupied(RayVoxels voxels) { return voxels.back().label == Label::occupied; }
bool is_behind(RayVoxels voxels) {
  return ends_occupied(voxels) && voxels.size() > 1 && is_unknown(voxels[voxels.size() - 2].label);
}

}  // namespace

InformationTable::InformationTable(const OccupancyProbabilities& probabilities) {
  probabilities.validate();
  for (const Label label : all_labels) {
    const double p = probabilities.of(label);
    entropy[static_cast<std::size_t>(label)] = vantage::entropy(p);
    transparency[static_cast<std::size_t>(label)] = 1 - p;
  }
}

void OcclusionAware::add(RayVoxels voxels) {
  double visible = 1;
  for (const RayVoxel& voxel : voxels) {
    sum += visible * table.entropy_of(voxel.label);
    visible *= table.transparency_of(voxel.label);
  }
}

void UnobservedVoxel::add(RayVoxels voxels) {
  double visible = 1;
  for (const RayVoxel& voxel : voxels) {
    if (is_unknown(voxel.label)) sum += visible * table.entropy_of(voxel.label);
    visible *= table.transparency_of(voxel.label);
  }
}

void RearSideVoxel::add(RayVoxels voxels) { sum += is_behind(voxels) ? 1 : 0; }

void RearSideEntropy::add(RayVoxels voxels) {
  if (!is_behind(voxels)) return;
  std::size_t first = voxels.size() - 1;
  while (first > 0 && is_unknown(voxels[first - 1].label)) --first;
  double visible = 1;
  for (std::size_t i = 0; i + 1 < voxels.size(); ++i) {
    if (i >= first) sum += visible * table.entropy_of(voxels[i].label);
    visible *= table.transparency_of(voxels[i].label);
  }
}

void AverageEntropy::add(RayVoxels voxels) {
  if (!ends_occupied(voxels)) return;
  for (const RayVoxel& voxel : voxels) sum += table.entropy_of(voxel.label);
  voxels_counted += static_cast<std::int64_t>(voxels.size());
}

void KriegelGain::add(RayVoxels voxels) {
  for (const RayVoxel& voxel : voxels) {
    if (is_unknown(voxel.label)) sum += table.entropy_of(voxel.label);
  }
}

CellsBehindSurface::CellsBehindSurface(const Choice& choice)
    : enclosure_(choice.map.enclosure()), limit_(std::min(std::round(reach / choice.map.grid().length), most_steps)) {
  const Index3 size = enclosure_.size();
  const Grid& grid = choice.map.grid();
  const LabelTable labels(choice.map);
  const auto per_slice = static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y());
  const auto farthest = static_cast<std::uint16_t>(limit_);
  cells_.assign(per_slice * static_cast<std::size_t>(size.z()), farthest);
  parallel_for(static_cast<std::size_t>(size.z()), [&](std::size_t z) {
    for (std::size_t i = 0; i < per_slice; ++i) {
      const Index3 local(static_cast<int>(i) % size.x(), static_cast<int>(i) / size.x(), static_cast<int>(z));
      const Index3 voxel = enclosure_.min + local;
      // Unmarked voxels lie behind nothing that was measured.
      if (labels.at(voxel) != Label::occluded && labels.at(voxel) != Label::occplane) continue;
      std::uint16_t& nearest = cells_[z * per_slice + i];
      const Vec3 center = grid.center(voxel);
      for (const View& scan : choice.scanned) {
        int steps = 0;
        visit_voxels(grid, enclosure_, LatticeRay(grid, center, Vec3(scan.position() - center)), 0,
                     [&](const Index3& passed, double) {
                       if (labels.at(passed) == Label::occupied)
                         nearest = static_cast<std::uint16_t>(steps);
                       else if (labels.at(passed) == Label::empty)
                         return false;
                       else
                         return ++steps < nearest;
                       return false;
                     });
      }
    }
  });
}

double CellsBehindSurface::at(const Index3& scene_index) const {
  const Index3 local = scene_index - enclosure_.min;
  const Index3 size = enclosure_.size();
  return cells_[(static_cast<std::size_t>(local.z()) * static_cast<std::size_t>(size.y()) +
                 static_cast<std::size_t>(local.y())) *
                    static_cast<std::size_t>(size.x()) +
                static_cast<std::size_t>(local.x())];
}

void ProximityCount::add(RayVoxels voxels) {
  for (const RayVoxel& voxel : voxels) {
    if (is_unknown(voxel.label)) sum += cells.limit() - cells.at(voxel.index);
  }
}

}  // namespace vantage
