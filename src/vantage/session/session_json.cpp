#include "vantage/session/session_json.hpp"

#include "vantage/runs/run_files.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

Json learned_json(const std::optional<ErrorLearner>& learner) {
  if (!learner) return nullptr;
  Json json{{"observations", learner->observations()}, {"left_out", learner->left_out()}};
  json.update(pose_error_json(learner->estimate()));
  return json;
}

}  // namespace

Json status_json(const SessionStatus& status) {
  const SessionState& state = *status.state;
  Json json;
  json["stored"] = status.stored;
  json["integrated"] = status.integrated;
  json["merged"] = status.merged;
  for (const Label label : all_labels) json["labels"][std::string(name(label))] = state.map.count(label);
  json["mean_quality"] = state.map.mean_quality();
  json["distance"] = state.scans.empty() ? 0.0 : state.scans.back().distance;
  json["radius"] = state.radius;
  json["sensor"] = sensor_json(state.sensor);
  json["learned_error"] = learned_json(state.learner);
  json["skipped"] = Json::array();
  for (const auto& [candidate, reason] : status.skipped) {
    json["skipped"].push_back({{"index", candidate}, {"reason", reason}});
  }
  json["removed"] = status.removed;
  json["left_out"] = Json::array();
  for (const auto& [number, reason] : status.left_out) {
    json["left_out"].push_back({{"number", number}, {"reason", reason}});
  }
  json["dropped"] = status.dropped;
  json["warnings"] = status.warnings;
  return json;
}

Json session_scan_json(int number, const ScanRecord& record) {
  Json json{{"number", number}};
  json.update(scan_json(record));
  return json;
}

}  // namespace vantage
