#include "vantage/runs/ranked_views.hpp"

#include <algorithm>

#include "vantage/runs/run_files.hpp"

namespace vantage {

nlohmann::ordered_json view_json(const Evaluation& e) {
  const Vec3 position = e.view.position();
  using Json = nlohmann::ordered_json;
  return {{"index", e.candidate},
          {"position", {position.x(), position.y(), position.z()}},
          {"feasible", e.feasible},
          {"reason", e.reason},
          {"columns", e.resolution.columns},
          {"rows", e.resolution.rows},
          {"n_oc", e.seen.occupied},
          {"n_op", e.seen.occplane},
          {"n_um", e.seen.unmarked},
          {"n_occluded", e.seen.occluded},
          {"x_oc", e.factors.x_oc},
          {"x_op", e.factors.x_op},
          {"f_area", e.factors.f_area},
          {"f_navigation", e.factors.f_navigation},
          {"f_quality", e.factors.f_quality},
          {"f_occlusion", e.factors.f_occlusion},
          {"utility", e.utility},
          {"score", e.score},
          {"expected_utility", e.expected ? Json(e.expected->utility) : Json(nullptr)},
          {"overlap_probability", e.expected ? Json(e.expected->registers) : Json(nullptr)},
          {"register_probability", e.registrability ? Json(e.registrability->probability) : Json(nullptr)},
          {"expected_misplacement", e.registrability ? Json(e.registrability->misplacement) : Json(nullptr)}};
}

nlohmann::ordered_json move_json(const Move& move) {
  nlohmann::ordered_json json{{"cost", move.cost}, {"path", nlohmann::ordered_json::array()}};
  for (const RobotState& state : move.path) {
    nlohmann::ordered_json place{{"pose", pose_numbers(state.view.world_from_sensor)}};
    if (state.joints.size() > 0) place["joints"] = std::vector<double>(state.joints.begin(), state.joints.end());
    json["path"].push_back(std::move(place));
  }
  return json;
}

nlohmann::ordered_json ranked_views_json(const std::optional<Plan>& plan, const std::string& why_finished,
                                         std::span<const ScanRecord> scans, int top) {
  const auto with_pose = [](const Evaluation& evaluation) {
    nlohmann::ordered_json json = view_json(evaluation);
    json["pose"] = pose_numbers(evaluation.view.world_from_sensor);
    return json;
  };
  nlohmann::ordered_json json;
  json["next"] = plan ? with_pose(plan->best) : nlohmann::ordered_json(nullptr);
  json["move"] = plan && plan->move.possible() ? move_json(plan->move) : nlohmann::ordered_json(nullptr);
  json["explanation"] = plan ? plan->explanation : why_finished;
  // A deadline, like multi-resolution, evaluates fewer to the end than could be chosen.
  json["evaluated"] = plan ? plan->ranking.size() : 0;
  json["feasible"] = plan ? plan->feasible : 0;
  json["ranking"] = nlohmann::ordered_json::array();
  json["infeasible"] = nlohmann::ordered_json::array();
  if (plan) {
    for (std::size_t i = 0; i < std::min(plan->ranking.size(), static_cast<std::size_t>(top)); ++i) {
      json["ranking"].push_back(with_pose(plan->ranking[i]));
    }
    for (const Evaluation& each : plan->infeasible) {
      json["infeasible"].push_back({{"index", each.candidate}, {"reason", each.reason}});
    }
  }
  json["tour"] = nlohmann::ordered_json::array();
  for (const TourStop& stop : plan ? plan->tour : std::vector<TourStop>()) {
    json["tour"].push_back({{"index", stop.candidate}, {"seconds", stop.seconds}, {"covered", stop.covered}});
  }
  json["scans"] = nlohmann::ordered_json::array();
  for (const ScanRecord& record : scans) json["scans"].push_back(scan_json(record));
  return json;
}

}  // namespace vantage
