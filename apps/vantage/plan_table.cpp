#include "plan_table.hpp"

#include <fmt/core.h>

#include "vantage/io/run_files.hpp"

namespace vantage::app {

nlohmann::ordered_json view_json(const Evaluation& e) {
  const Vec3 position = e.view.position();
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
          {"utility", e.utility}};
}

void print_views(std::vector<Evaluation> evaluations, int top) {
  rank(evaluations);
  fmt::print("{:>5} {:>24} {:>6} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>8}\n", "view", "position [m]", "n_oc", "n_op",
             "n_um", "f_area", "f_nav", "f_qual", "f_occl", "utility");
  int printed = 0;
  for (const Evaluation& e : evaluations) {
    if (!e.feasible) continue;
    if (++printed > top) break;
    const Vec3 p = e.view.position();
    fmt::print("{:>5} {:>24} {:>6} {:>6} {:>6} {:>7.4f} {:>7.4f} {:>7.4f} {:>7.4f} {:>8.5f}\n", e.candidate,
               fmt::format("{:.3f} {:.3f} {:.3f}", p.x(), p.y(), p.z()), e.seen.occupied, e.seen.occplane,
               e.seen.unmarked, e.factors.f_area, e.factors.f_navigation, e.factors.f_quality, e.factors.f_occlusion,
               e.utility);
  }
  for (const Evaluation& e : evaluations) {
    if (!e.feasible) fmt::print("{:>5} not feasible: {}\n", e.candidate, e.reason);
  }
}

void print_plan(const std::optional<Plan>& plan, const std::string& why_finished, int top) {
  if (!plan) {
    fmt::print("nothing left to plan: {}\n", why_finished);
    return;
  }
  const std::array<double, 7> pose = pose_numbers(plan->best.view.world_from_sensor);
  fmt::print("next best view: {}\n  {}\n", plan->best.candidate, plan->explanation);
  fmt::print("  pose (x y z qx qy qz qw, world from sensor): {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n\n",
             pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6]);
  std::vector<Evaluation> all = plan->ranking;
  all.insert(all.end(), plan->infeasible.begin(), plan->infeasible.end());
  print_views(all, top);
}

nlohmann::ordered_json plan_json(const std::optional<Plan>& plan, const std::string& why_finished,
                                 const ObjectModel& model, int top) {
  const auto with_pose = [](const Evaluation& evaluation) {
    nlohmann::ordered_json json = view_json(evaluation);
    json["pose"] = pose_numbers(evaluation.view.world_from_sensor);
    return json;
  };
  nlohmann::ordered_json json;
  json["next"] = plan ? with_pose(plan->best) : nlohmann::ordered_json(nullptr);
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
  json["scans"] = nlohmann::ordered_json::array();
  for (const ScanRecord& record : model.scans) json["scans"].push_back(scan_json(record));
  return json;
}

}  // namespace vantage::app
