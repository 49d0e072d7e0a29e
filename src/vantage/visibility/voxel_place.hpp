#pragma once

#include <cstdint>

#include "vantage/map/voxel_map.hpp"

namespace vantage {

/// A voxel's number in the enclosure, x fastest, without gaps. The largest enclosure has 2^31 voxels.
[[nodiscard]] inline std::uint32_t place_of(const BitLayout& layout, const Index3& local) {
  const auto at = [](int index) { return static_cast<std::uint32_t>(index); };
  return (at(local.z()) * at(layout.size.y()) + at(local.y())) * at(layout.size.x()) + at(local.x());
}

/// The voxel with this number, by its local index.
[[nodiscard]] inline Index3 voxel_at(const BitLayout& layout, std::uint32_t place) {
  const auto nx = static_cast<std::uint32_t>(layout.size.x()), ny = static_cast<std::uint32_t>(layout.size.y());
  return {static_cast<int>(place % nx), static_cast<int>(place / nx % ny), static_cast<int>(place / nx / ny)};
}

}  // namespace vantage
