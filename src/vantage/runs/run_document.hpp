#pragma once

#include <nlohmann/json_fwd.hpp>

#include "vantage/runs/run_data.hpp"

namespace vantage {

/// Parts of RunData as docs/report-data.md defines them; the live server sends them as events.
[[nodiscard]] nlohmann::ordered_json scan_json(const RecordedScan& scan);
[[nodiscard]] nlohmann::ordered_json plan_json(const CandidatePlan& plan);
/// Cloud and mesh of the run as it is, and how it stands.
[[nodiscard]] nlohmann::ordered_json result_json(const RunData& run);
[[nodiscard]] nlohmann::ordered_json state_json(const RunData& run);
/// Camera and candidates.
[[nodiscard]] nlohmann::ordered_json setup_json(const RunData& run);
/// The whole document.
[[nodiscard]] nlohmann::ordered_json run_json(const RunData& run);

}  // namespace vantage
