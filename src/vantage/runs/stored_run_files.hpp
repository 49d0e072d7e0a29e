#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/model/scan_record.hpp"

namespace vantage {

/// What summary.json says of the scans of a run.
struct StoredSummary {
  std::optional<std::string> object;
  std::vector<ScanRecord> scans;  // number, candidate, poses, verdict and residual
};

/// Reads the text of a summary.json; `name` stands in errors. Throws InputError naming the field.
[[nodiscard]] StoredSummary parse_run_summary(std::string_view bytes, const std::string& name);

/// What config.yaml says of the sensor and of the views to choose from.
struct StoredConfig {
  std::optional<std::string> camera, candidates;  // for camera_from_text() and candidates_from_text()
};

/// Reads the text of a config.yaml; other options are passed over. Throws InputError naming the line or the field.
[[nodiscard]] StoredConfig parse_run_config(std::string_view bytes, const std::string& name);

}  // namespace vantage
