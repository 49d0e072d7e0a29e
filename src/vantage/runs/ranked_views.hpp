#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "vantage/model/scan_record.hpp"
#include "vantage/planning/planner.hpp"

namespace vantage {

/// A view's evaluation under the keys of `evaluate --json` (spec, section 11).
[[nodiscard]] nlohmann::ordered_json view_json(const Evaluation& evaluation);

/// {"cost", "path": [{"pose", "joints"}]}: corner places of the way, with joints (radians, metres) where the robot has
/// any.
[[nodiscard]] nlohmann::ordered_json move_json(const Move& move);

/// What `plan --json` and `session next --json` print: the next best view or null, the move there, why, the `top` best
/// views in rank with their poses (x y z qx qy qz qw, world from sensor), the candidates that fell out with the reason,
/// the tour over the rest of the scan where one is planned, and a record of each scan.
[[nodiscard]] nlohmann::ordered_json ranked_views_json(const std::optional<Plan>& plan, const std::string& why_finished,
                                                       std::span<const ScanRecord> scans, int top);

}  // namespace vantage
