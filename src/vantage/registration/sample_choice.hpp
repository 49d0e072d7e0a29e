#pragma once

#include <span>
#include <vector>

#include "vantage/registration/scan_surface.hpp"

namespace vantage {

/// At most `most` of the samples, evenly over their order.
[[nodiscard]] std::vector<SurfaceSample> picked_evenly(std::span<const SurfaceSample> all, std::size_t most);

/// At most `most` of the samples, as evenly over the directions of their normals as there are samples: few that hold a
/// direction do not drown in a table that holds another.
[[nodiscard]] std::vector<SurfaceSample> picked_by_normal(std::span<const SurfaceSample> all, std::size_t most);

}  // namespace vantage
