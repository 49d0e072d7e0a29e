#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "vantage/model/mesh_quality.hpp"
#include "vantage/model/reconstruction.hpp"

namespace vantage {

/// What a reconstruction came to, beside the model itself.
struct RunSummary {
  std::string object;
  std::string stop_reason;
  std::uint64_t seed = 0;
  /// Distances of the fused points to the true surface, metres, and shares of the true surface within 5 mm of a fused
  /// point; known in simulation only.
  std::optional<double> accuracy_rms, accuracy_95, completeness, completeness_all;
  std::optional<MeshQuality> mesh;  // of mesh.ply
};

/// A pose as x y z qx qy qz qw with qw >= 0.
[[nodiscard]] std::array<double, 7> pose_numbers(const Pose& pose);

/// Mean and covariance of x, y, z, pan, tilt, roll; metres and degrees.
[[nodiscard]] nlohmann::ordered_json pose_error_json(const PoseError& error);

/// The deviation of a depth z under the incidence t, constant + linear z + quadratic z^2 + incidence tan^2 t, and the
/// steps between depths; metres.
[[nodiscard]] nlohmann::ordered_json sensor_json(const SensorModel& sensor);

/// The object `mesh` of `summary.json`: square metres, cubic metres, metres.
[[nodiscard]] nlohmann::ordered_json mesh_quality_json(const MeshQuality& quality);

/// One scan as the keys of spec section 10; absent values are null. Poses are arrays of 7 numbers.
[[nodiscard]] nlohmann::ordered_json scan_json(const ScanRecord& record);

/// Of `summary.json`, the key `format`; 0.1 wrote none.
constexpr int summary_format = 1;
/// The content of `summary.json`.
[[nodiscard]] nlohmann::ordered_json summary_json(const ObjectModel& model, const RunSummary& summary);

/// The content of `views.csv`: a header and one row per scan; poses take seven columns each.
[[nodiscard]] std::string views_csv(const std::vector<ScanRecord>& scans);

/// The content of `timings.json`: seconds per scan and step, and `total` for the whole run.
[[nodiscard]] nlohmann::ordered_json timings_json(const std::vector<ScanRecord>& scans, double total_seconds);

}  // namespace vantage
