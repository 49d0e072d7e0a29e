#include <cstdlib>
#include <vector>

#include "vantage/map/integrate.hpp"
#include "vantage/map/voxel_ray.hpp"

namespace vantage {
namespace {

int steps_between(const Index3& a, const Index3& b) { return (a - b).cwiseAbs().sum(); }

/// Bits set by the rays of a scan, one per voxel of the enclosure.
struct Marks {
  BitPlane emptied, behind;
};

void trace(const VoxelMap& map, const SightLine& line, Marks& marks) {
  const LatticeRay ray(map.grid(), line.origin, line.direction);
  const Index3 hit = line.is_hit ? map.grid().index_of(line.hit_point()) : ray.origin_cell;
  const int steps_to_hit = steps_between(hit, ray.origin_cell);
  const bool labels_behind = line.is_hit && map.enclosure().contains(hit);
  int steps = -1;
  visit_voxels(map.grid(), map.enclosure(), ray, line.near, [&](const Index3& index, double entered) {
    steps = steps < 0 ? steps_between(index, ray.origin_cell) : steps + 1;
    const bool before_end = line.is_hit ? steps < steps_to_hit : entered <= line.end;
    if (!before_end && !labels_behind) return false;
    const Index3 local = index - map.enclosure().min;
    if (before_end) {
      marks.emptied.words[map.layout().word(local)] |= BitLayout::bit(local);
    } else if (steps > steps_to_hit) {
      marks.behind.words[map.layout().word(local)] |= BitLayout::bit(local);
    }
    return true;
  });
}

}  // namespace

IntegrationReport integrate_exactly(VoxelMap& map, std::span<const SightLine> lines) {
  IntegrationReport report;
  for (const SightLine& line : lines) {
    if (!line.is_hit) continue;
    const Index3 index = map.grid().index_of(line.hit_point());
    if (!map.enclosure().contains(index)) continue;
    ++report.points_in_enclosure;
    if (map.add_point(index, line.normal, line.quality)) ++report.new_occupied;
  }
  Marks marks;
  marks.emptied.words.assign(map.layout().words(), 0);
  marks.behind.words.assign(map.layout().words(), 0);
  for (const SightLine& line : lines) trace(map, line, marks);
  for (std::size_t word = 0; word < map.layout().words(); ++word) {
    map.carve_word(word, marks.emptied.words[word], marks.behind.words[word]);
  }
  map.update_occplane();
  return report;
}

}  // namespace vantage
