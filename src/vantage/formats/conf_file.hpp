#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// One scan of a Stanford `.conf`.
struct ConfScan {
  std::string file;
  Pose world_from_scan = Pose::Identity();
};
/// The lines `bmesh FILE tx ty tz qx qy qz qw` (or `mesh`); others are ignored. p_world = transpose(R(q)) p_scan + t.
[[nodiscard]] std::vector<ConfScan> parse_conf(std::string_view bytes, const std::string& name);

}  // namespace vantage
