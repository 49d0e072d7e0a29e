#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cli_options.hpp"
#include "commands.hpp"
#include "program_options.hpp"
#include "vantage/io/map_file.hpp"

namespace vantage::app {
namespace {

struct Request {
  std::string map;
  Vec3 current{0, 0, 2};
  int top = 10;
  ReconstructOptions options;
  ProgramOptions program;
};

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

/// Every candidate, infeasible ones too, in the order of their indices.
std::vector<Evaluation> evaluate_all(const VoxelMap& map, const Planner& planner, const View& current) {
  const VisibilityEvaluator visibility(map);
  const ViewEvaluation problem{
      visibility,       planner.camera(), planner.candidates(),      map.grid().length,
      planner.travel(), current,          planner.options().factors, utility_by_name(planner.options().utility)};
  std::vector<int> all(planner.candidates().views.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Resolution> resolutions;
  for (const int i : all) resolutions.push_back(problem.resolution(i, planner.options().rays));
  std::vector<Evaluation> evaluations = problem.evaluate(all, resolutions);
  for (Evaluation& each : evaluations) {
    const auto reason = why_infeasible(map, each.view, planner.options().reach);
    each.feasible = !reason;
    each.reason = reason.value_or("");
  }
  return evaluations;
}

void print_json(const VoxelMap& map, const std::vector<Evaluation>& evaluations) {
  nlohmann::ordered_json json;
  for (const Label label : all_labels) json["labels"][std::string(name(label))] = map.count(label);
  json["mean_quality"] = map.mean_quality();
  json["views"] = nlohmann::ordered_json::array();
  for (const Evaluation& each : evaluations) json["views"].push_back(view_json(each));
  fmt::print("{}\n", json.dump(2));
}

void print_table(const VoxelMap& map, std::vector<Evaluation> evaluations, int top) {
  for (const Label label : all_labels) fmt::print("{} {}  ", map.count(label), name(label));
  fmt::print(" mean quality {:.3f}\n\n", map.mean_quality());
  fmt::print("{:>5} {:>24} {:>6} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>8}\n", "view", "position [m]", "n_oc", "n_op",
             "n_um", "f_area", "f_nav", "f_qual", "f_occl", "utility");
  rank(evaluations);
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

void evaluate(const Request& request) {
  const auto threads = limit_threads(request.program.threads);
  require(request.top >= 0, "top = ", request.top, ": must not be negative");
  const VoxelMap map = read_map(request.map);
  const Planner planner(candidates_from_text(request.options.candidates, map.enclosure_center()),
                        request.options.range_camera(), request.options.planner_options());
  const View current{Pose(Eigen::Translation3d(request.current))};
  const std::vector<Evaluation> evaluations = evaluate_all(map, planner, current);
  if (request.program.json) {
    print_json(map, evaluations);
  } else {
    print_table(map, evaluations, request.top);
  }
}

}  // namespace

void add_evaluate(CLI::App& program) {
  auto request = std::make_shared<Request>();
  CLI::App* command = program.add_subcommand("evaluate", "Evaluate candidate views on a map from a file");
  command->add_option("map", request->map, "map file, NAME.nrrd with NAME.ply beside it")->required();
  OptionAdder add(*command);
  add("current", request->current, "m", "where the sensor is now");
  add("top", request->top, "", "views to print, best first");
  add_options(*command, request->options,
              {"candidates", "camera", "depth-range", "max-incidence", "rays", "utility", "alpha-oc", "alpha-op", "rho",
               "navigation", "body-radius", "workspace", "obstacles"});
  add_program_options(*command, request->program);
  command->callback([request] { evaluate(*request); });
}

}  // namespace vantage::app
