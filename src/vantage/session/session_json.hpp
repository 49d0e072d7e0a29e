#pragma once

#include <nlohmann/json.hpp>

#include "vantage/session/session.hpp"

namespace vantage {

/// How a session stands: `stored`, `integrated`, `merged` scans, `labels`, `mean_quality`, `distance`, `radius`,
/// `skipped`, `left_out`, `dropped`, `warnings`.
[[nodiscard]] nlohmann::ordered_json status_json(const SessionStatus& status);

/// The record of a scan as in summary.json, with its `number` in the session before.
[[nodiscard]] nlohmann::ordered_json session_scan_json(int number, const ScanRecord& record);

}  // namespace vantage
