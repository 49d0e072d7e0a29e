#include "vantage/report/report_data.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// The layer of the enclosure at `z` after every scan, from the changes that each scan made.
std::vector<std::pair<int, LabelLayer>> layers_of(const RunData& run, const VoxelMap& map, int z) {
  LabelLayer layer = label_layer(map, z);
  const std::size_t size = layer.labels.size();
  const std::size_t first = size * static_cast<std::size_t>(z - map.enclosure().min.z());
  std::fill(layer.labels.begin(), layer.labels.end(), Label::unmarked);
  std::vector<std::pair<int, LabelLayer>> layers;
  for (const RecordedScan& scan : run.scans) {
    const std::vector<std::uint8_t>& changed = scan.change.labels;
    require(changed.size() >= first + size, "scan ", scan.record.scan, ": its change has ", changed.size(),
            " labels, fewer than the enclosure has voxels");
    for (std::size_t i = 0; i < size; ++i)
      if (changed[first + i] != 0) layer.labels[i] = static_cast<Label>(changed[first + i] - 1);
    layers.emplace_back(scan.record.scan, layer);
  }
  return layers;
}

}  // namespace

ReportData report_data(const RunData& run, const VoxelMap& map) {
  ReportData data;
  data.object = run.object;
  data.command = run.command;
  data.program = run.program;
  data.options = run.options;
  data.camera = run.camera;
  data.candidates = run.candidates;
  for (const RecordedScan& scan : run.scans) data.scans.push_back(scan.record);
  data.stop_reason = run.stop_reason;
  data.map = &map;
  data.cloud = &run.cloud;
  data.mesh = &run.mesh;
  data.layers = layers_of(run, map, middle_layer(map));
  return data;
}

}  // namespace vantage
