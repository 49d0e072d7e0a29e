#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Where the sensor may be (spec, section 2).
struct ReachOptions {
  double body_radius = 0;         // metres; the robot's body is a ball around the sensor
  std::optional<Box3> workspace;  // the sensor stays inside; unlimited by default
  std::vector<Box3> obstacles;    // known solids, besides what the map holds

  void validate() const;
};

/// Why the robot cannot be at `view`, or nothing where it can: outside of the workspace, or its body touches an
/// obstacle or a voxel that is not known to be empty.
[[nodiscard]] std::optional<std::string> why_infeasible(const VoxelMap& map, const View& view,
                                                        const ReachOptions& options);

}  // namespace vantage
