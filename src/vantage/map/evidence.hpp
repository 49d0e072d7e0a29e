#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace vantage {

/// How a map comes to its labels. paper: a voxel with a point is occupied for ever (paper, section 4). evidence: points
/// and looks through a voxel are counted against each other, so that stray points and flying pixels do not stay.
enum class MapRule { paper, evidence };

inline constexpr std::array<std::pair<MapRule, const char*>, 2> map_rules{
    {{MapRule::paper, "paper"}, {MapRule::evidence, "evidence"}}};
[[nodiscard]] inline const auto& names_of(MapRule) { return map_rules; }

/// What speaks for and against a surface in a voxel. Both count scans, two for each; a scan of which a single point
/// without a normal falls into the voxel, a stray one, counts one.
struct VoxelEvidence {
  static constexpr int per_scan = 2;
  static constexpr std::uint8_t most = 254;

  std::uint8_t support = 0;
  std::uint8_t contradiction = 0;  // by scans whose every ray through the voxel ends well behind it

  /// A stray point is not enough; and more scans must have seen the surface than looked through it, or as many.
  [[nodiscard]] bool is_occupied() const { return support >= per_scan && support >= contradiction; }
  void add_support(int amount) { support = static_cast<std::uint8_t>(std::min(support + amount, int{most})); }
  void add_contradiction() { contradiction = static_cast<std::uint8_t>(std::min(contradiction + per_scan, int{most})); }
  bool operator==(const VoxelEvidence&) const = default;
};

/// A ray looks through a voxel where it ends more than this many steps behind it: the surface of any of the voxels
/// around (at most three steps away) may, by noise, have been measured in this one.
inline constexpr int steps_looked_through = 3;

}  // namespace vantage
