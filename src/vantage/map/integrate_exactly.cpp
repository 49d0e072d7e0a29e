#include <algorithm>
#include <atomic>

#include "vantage/core/parallel.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/map/point_support.hpp"
#include "vantage/map/sensor_distance.hpp"
#include "vantage/map/voxel_ray.hpp"

namespace vantage {
namespace {

int steps_between(const Index3& a, const Index3& b) { return (a - b).cwiseAbs().sum(); }

/// Bits set by the rays of a scan, one per voxel of the enclosure. Rays may run at the same time: bits are only set, so
/// that the order does not matter.
struct Marks {
  BitPlane emptied, behind;
  BitPlane looked_through, not_looked_through;  // by a ray at least; by the rule `evidence` only
};

void set_bit(BitPlane& plane, const BitLayout& layout, const Index3& local) {
  const std::atomic_ref word(plane.words[layout.word(local)]);
  const std::uint64_t bit = BitLayout::bit(local);
  if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
}

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
      set_bit(marks.emptied, map.layout(), local);
    } else if (steps > steps_to_hit) {
      set_bit(marks.behind, map.layout(), local);
    }
    return true;
  });
}

/// Marks the voxels of a ray that it does and that it does not look through.
void look_through(const VoxelMap& map, const SightLine& line, Marks& marks) {
  const LatticeRay ray(map.grid(), line.origin, line.direction);
  const double beyond = distance_beyond(map.grid(), map.enclosure(), line.origin) / line.direction.norm();
  const std::int64_t steps_to_end = line.is_hit ? steps_between(map.grid().index_of(line.hit_point()), ray.origin_cell)
                                                : crossings_until(map.grid(), ray, std::min(line.end, beyond)) + 1;
  visit_voxels(map.grid(), map.enclosure(), ray, line.near, [&](const Index3& index, double) {
    const std::int64_t steps = steps_between(index, ray.origin_cell);
    const bool is_through = steps + steps_looked_through < steps_to_end;
    set_bit(is_through ? marks.looked_through : marks.not_looked_through, map.layout(), index - map.enclosure().min);
    return true;
  });
}

}  // namespace

IntegrationReport integrate_exactly(VoxelMap& map, std::span<const SightLine> lines) {
  IntegrationReport report;
  for (const SightLine& line : lines) require_near(map.grid(), line.origin);
  PointSupport points(map);
  // A scan that has no normals at all says nothing by their absence.
  const bool has_normals = std::any_of(lines.begin(), lines.end(),
                                       [](const SightLine& line) { return line.is_hit && !line.normal.isZero(0); });
  for (const SightLine& line : lines) {
    if (!line.is_hit) continue;
    const Index3 index = map.grid().index_of(line.hit_point());
    if (!map.enclosure().contains(index)) continue;
    ++report.points_in_enclosure;
    const bool has_normal = !line.normal.isZero(0);
    const auto [surface, is_new] = points.add(index, has_normal || !has_normals);
    if (is_new) ++report.new_occupied;
    if (surface != nullptr && has_normal) surface->add(line.normal, line.quality);
  }
  Marks marks;
  for (BitPlane* plane : {&marks.emptied, &marks.behind}) plane->words.assign(map.layout().words(), 0);
  const bool counts = map.rule() == MapRule::evidence;
  if (counts) marks.looked_through = marks.not_looked_through = marks.emptied;
  constexpr std::size_t lines_per_task = 1024;
  parallel_for((lines.size() + lines_per_task - 1) / lines_per_task, [&](std::size_t task) {
    const std::size_t first = task * lines_per_task;
    for (const SightLine& line : lines.subspan(first, std::min(lines_per_task, lines.size() - first))) {
      trace(map, line, marks);
      if (counts) look_through(map, line, marks);
    }
  });
  for (std::size_t word = 0; word < map.layout().words(); ++word) {
    if (counts) {
      report.taken_back +=
          map.contradict_word(word, marks.looked_through.words[word] & ~marks.not_looked_through.words[word]);
    }
    map.carve_word(word, marks.emptied.words[word], marks.behind.words[word]);
  }
  points.finish();
  map.update_occplane();
  return report;
}

}  // namespace vantage
