#include "vantage/runs/run_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

template <class Integer>
Integer scaled(double value, double scale) {
  return static_cast<Integer>(std::lround(std::clamp(value, -1.0, 1.0) * scale));
}

bool same_surface(const SurfaceVoxel& a, const SurfaceVoxel& b) {
  return a.normal_sum == b.normal_sum && a.quality == b.quality;
}

/// A change and the one after it as one.
void add_change(MapChange& change, const MapChange& next) {
  for (std::size_t i = 0; i < next.labels.size(); ++i) {
    if (next.labels[i] != 0) change.labels[i] = next.labels[i];
  }
  MapChange both{std::move(change.labels), {}, {}, {}};
  const auto take = [&both](const MapChange& from, std::size_t at) {
    both.voxels.push_back(from.voxels[at]);
    for (std::size_t axis = 0; axis < 3; ++axis) both.normals.push_back(from.normals[3 * at + axis]);
    both.quality.push_back(from.quality[at]);
  };
  std::size_t old = 0;
  for (std::size_t i = 0; i < next.voxels.size(); ++i) {
    for (; old < change.voxels.size() && change.voxels[old] < next.voxels[i]; ++old) take(change, old);
    if (old < change.voxels.size() && change.voxels[old] == next.voxels[i]) ++old;
    take(next, i);
  }
  for (; old < change.voxels.size(); ++old) take(change, old);
  change = std::move(both);
}

}  // namespace

MapChange MapRecorder::changes(const VoxelMap& map) {
  const IndexBox& box = map.enclosure();
  const Index3 size = box.size();
  const auto voxel_count = static_cast<std::size_t>(size.cast<std::int64_t>().prod());
  if (labels_.empty()) labels_.assign(voxel_count, Label::unmarked);
  require(labels_.size() == voxel_count, "map recorder: the enclosure has ", voxel_count, " voxels, before it had ",
          labels_.size());
  MapChange change;
  change.labels.resize(voxel_count);
  std::vector<std::uint32_t> occupied;
  std::vector<SurfaceVoxel> surfaces;
  std::size_t known = 0;  // place in occupied_ and surfaces_
  std::uint32_t voxel = 0;
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x, ++voxel) {
        const Label label = map.label({x, y, z});
        if (label != labels_[voxel]) change.labels[voxel] = static_cast<std::uint8_t>(1 + static_cast<int>(label));
        labels_[voxel] = label;
        if (label != Label::occupied) continue;
        const SurfaceVoxel& surface = *map.surface({x, y, z});
        occupied.push_back(voxel);
        surfaces.push_back(surface);
        while (known < occupied_.size() && occupied_[known] < voxel) ++known;
        const bool was_occupied = known < occupied_.size() && occupied_[known] == voxel;
        if (same_surface(surface, was_occupied ? surfaces_[known] : SurfaceVoxel{})) continue;
        change.voxels.push_back(voxel);
        const Vec3 normal = surface.normal();
        for (int axis = 0; axis < 3; ++axis) change.normals.push_back(scaled<std::int8_t>(normal[axis], 127));
        change.quality.push_back(scaled<std::uint8_t>(std::max(0.0, surface.quality), 255));
      }
    }
  }
  occupied_ = std::move(occupied);
  surfaces_ = std::move(surfaces);
  return change;
}

CandidatePlan candidate_plan(const Plan& plan, std::size_t candidates) {
  CandidatePlan result;
  result.chosen = plan.best.candidate;
  result.evaluations.resize(candidates);
  for (const auto* list : {&plan.ranking, &plan.infeasible}) {
    for (const Evaluation& evaluation : *list) {
      result.evaluations.at(static_cast<std::size_t>(evaluation.candidate)) = evaluation;
      if (evaluation.score != evaluation.utility) result.convolved = true;
    }
  }
  return result;
}

void RunData::add_scan(const ScanRecord& record, const ObjectModel& model, const Plan* plan) {
  RecordedScan scan{record, std::nullopt, recorder_.changes(model.map)};
  if (plan != nullptr) scan.plan = candidate_plan(*plan, candidates.views.size());
  scans.push_back(std::move(scan));
}

void RunData::finish(const ObjectModel& model, const std::string& reason) {
  state = State::finished;
  stop_reason = reason;
  next.reset();
  cloud = model.surface.cloud();
  scan_of_point.resize(cloud.size());
  constexpr std::size_t last_number = std::numeric_limits<std::uint16_t>::max();
  std::size_t first = 0;
  for (const auto& [scan, size] : model.cloud_growth) {
    const auto number = static_cast<std::uint16_t>(std::min(static_cast<std::size_t>(scan), last_number));
    for (; first < std::min(size, cloud.size()); ++first) scan_of_point[first] = number;
  }
  for (std::size_t i = 0; i < std::min(scans.size(), model.scans.size()); ++i) scans[i].record = model.scans[i];
  if (!scans.empty()) add_change(scans.back().change, recorder_.changes(model.map));
}

}  // namespace vantage
