#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cli_options.hpp"
#include "commands.hpp"
#include "cost_note.hpp"
#include "current_place.hpp"
#include "notes.hpp"
#include "plan_table.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/runs/ranked_views.hpp"

namespace vantage::app {
namespace {

struct EvaluateRequest {
  std::string map;
  int top = 10;
  CurrentPlace place;
  ReconstructOptions options;
  std::set<std::string> given;  // names of options that the user set
  ProgramOptions program;
};

/// Every candidate, infeasible ones too, in the order of their indices.
std::vector<Evaluation> evaluate_all(const VoxelMap& map, const Planner& planner, const View& current) {
  const VisibilityEvaluator visibility(map);
  const Utility utility = planner.options().make_utility();
  const ViewEvaluation problem{map,
                               visibility,
                               planner.camera(),
                               planner.candidates(),
                               map.grid().length,
                               planner.travel(),
                               current,
                               planner.options().factors,
                               utility};
  std::vector<int> all(planner.candidates().views.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Resolution> resolutions;
  for (const int i : all) resolutions.push_back(problem.resolution(i, planner.options().rays));
  std::vector<Evaluation> evaluations = problem.evaluate(all, resolutions);
  const std::vector<std::optional<std::string>> reasons = planner.why_infeasible_now(map, current);
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    evaluations[i].feasible = !reasons[i];
    evaluations[i].reason = reasons[i].value_or("");
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

void print_labels(const VoxelMap& map) {
  for (const Label label : all_labels) fmt::print("{} {}  ", map.count(label), name(label));
  fmt::print(" mean quality {:.3f}\n\n", map.mean_quality());
}

void evaluate(EvaluateRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  require(request.top >= 0, "top = ", request.top, ": must not be negative");
  print_hints(load_robot(request.options, request.given));
  const VoxelMap map = read_map(request.map);
  const Planner planner(candidates_from_text(request.options.candidates, map.enclosure_center()),
                        request.options.range_camera(), request.options.planner_options());
  const Resolution rays = planner.options().rays.kind == RayChoice::Kind::fixed ? planner.options().rays.resolution
                                                                                : planner.camera().resolution;
  const std::string cost = cost_note(planner.candidates().views.size(), rays);
  if (!cost.empty() && !request.program.quiet) print_note("{}\n", cost);
  const View current{Pose(Eigen::Translation3d(request.place.current))};
  const std::vector<Evaluation> evaluations = evaluate_all(map, planner, current);
  if (request.program.json) {
    print_json(map, evaluations);
  } else {
    print_labels(map);
    print_views(evaluations, {request.top, request.program.verbose});
  }
}

}  // namespace

void add_evaluate(CLI::App& program) {
  auto request = std::make_shared<EvaluateRequest>();
  CLI::App* command = program.add_subcommand("evaluate", "Evaluate candidate views on a map from a file");
  command->add_option("map", request->map, "map file, NAME.nrrd with NAME.ply beside it")->required();
  command->add_option("--top", request->top, "views to print, best first")->capture_default_str();
  std::vector<OptionField> fields = option_fields(request->place);
  for (OptionField& field : fields_named(option_fields(request->options), planning_option_names())) {
    if (field.name != "deadline" && field.name != "travel")
      fields.push_back(std::move(field));  // it evaluates every candidate
  }
  add_options(*command, noting(std::move(fields), request->given));
  add_program_options(*command, request->program);
  command->callback([request] { evaluate(*request); });
}

}  // namespace vantage::app
