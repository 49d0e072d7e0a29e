#include "vantage/search/search.hpp"

#include <algorithm>
#include <numeric>

#include "vantage/core/error.hpp"

namespace vantage {

namespace {
constexpr int most_fixed_rays = 16384;  // per axis, as of a camera
}  // namespace

void RayChoice::validate() const {
  if (kind != Kind::fixed) return;
  const auto [columns, rows] = resolution;
  require(columns > 0 && rows > 0 && columns <= most_fixed_rays && rows <= most_fixed_rays, "rays = ", columns, "x",
          rows, ": must be `sensor`, `ideal` or columns and rows of 1 to ", most_fixed_rays, " such as 79x79");
}

Resolution ViewEvaluation::ideal(int candidate) const {
  const Vec3 position = candidates.views[static_cast<std::size_t>(candidate)].position();
  return ideal_resolution(camera, voxel_length, (position - candidates.center).norm());
}

Resolution ViewEvaluation::resolution(int candidate, const RayChoice& rays) const {
  switch (rays.kind) {
    case RayChoice::Kind::ideal:
      return ideal(candidate);
    case RayChoice::Kind::fixed:
      return rays.resolution;
    case RayChoice::Kind::sensor:
      break;
  }
  return camera.resolution;
}

std::vector<View> ViewEvaluation::views_of(std::span<const int> candidate_indices) const {
  std::vector<View> views;
  views.reserve(candidate_indices.size());
  for (const int index : candidate_indices) views.push_back(candidates.views[static_cast<std::size_t>(index)]);
  return views;
}

Evaluation ViewEvaluation::evaluation(int candidate, Resolution rays, const Visibility& seen) const {
  Evaluation result;
  result.candidate = candidate;
  result.view = candidates.views[static_cast<std::size_t>(candidate)];
  result.resolution = rays;
  result.seen = seen;
  return with_cost(std::move(result), normalised_cost(candidate));
}

double ViewEvaluation::normalised_cost(int candidate) const {
  if (!normalised_costs.empty()) return normalised_costs[static_cast<std::size_t>(candidate)];
  return travel.normalised(current.position(), candidates.views[static_cast<std::size_t>(candidate)].position());
}

Evaluation ViewEvaluation::with_cost(Evaluation result, double cost) const {
  result.factors = factors(result.seen, cost, options);
  // What is judged by other things than counts keeps its utility.
  if (const auto* by_counts = std::get_if<CountUtility>(&utility.score)) {
    result.utility = (*by_counts)(result.seen, result.factors);
    result.score = result.utility;
  }
  return result;
}

void ViewEvaluation::score(std::vector<Evaluation>& evaluations,
                           std::optional<std::chrono::steady_clock::time_point> deadline) const {
  const std::vector<ViewToJudge> views = to_judge(evaluations);
  const std::vector<double> scores = judge(utility, choice(views, deadline));
  for (std::size_t i = 0; i < scores.size(); ++i) evaluations[i].score = evaluations[i].utility = scores[i];
}

Choice ViewEvaluation::choice(std::span<const ViewToJudge> views,
                              std::optional<std::chrono::steady_clock::time_point> deadline) const {
  return {map, visibility, camera, current, scanned, seed, views, deadline, refused, travel};
}

std::vector<TourStop> ViewEvaluation::tour(const std::vector<Evaluation>& evaluations) const {
  if (!utility.tour) return {};
  const std::vector<ViewToJudge> views = to_judge(evaluations);
  return utility.tour(choice(views, std::nullopt));
}

std::vector<ViewToJudge> ViewEvaluation::to_judge(const std::vector<Evaluation>& evaluations) const {
  // What judges by counts asks nothing about rays, and views may be too far off to have ideal ones.
  const bool needs_ideal = !std::holds_alternative<CountUtility>(utility.score);
  std::vector<ViewToJudge> views;
  views.reserve(evaluations.size());
  for (const Evaluation& each : evaluations) {
    views.push_back({each.candidate, each.view, each.resolution, needs_ideal ? ideal(each.candidate) : each.resolution,
                     normalised_cost(each.candidate), each.seen, each.factors});
  }
  return views;
}

std::vector<Evaluation> ViewEvaluation::evaluate(std::span<const int> candidate_indices,
                                                 std::span<const Resolution> resolutions) const {
  const std::vector<Visibility> seen = visibility.see(camera, views_of(candidate_indices), resolutions);
  std::vector<Evaluation> evaluations;
  evaluations.reserve(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    evaluations.push_back(evaluation(candidate_indices[i], resolutions[resolutions.size() == 1 ? 0 : i], seen[i]));
  }
  score(evaluations);
  return evaluations;
}

std::vector<Evaluation> ViewEvaluation::look_until(std::chrono::steady_clock::time_point deadline,
                                                   std::span<const int> candidate_indices,
                                                   std::span<const Resolution> resolutions) const {
  std::vector<std::size_t> order(candidate_indices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<std::optional<Visibility>> seen =
      visibility.see_until(deadline, camera, views_of(candidate_indices), resolutions, order);
  std::vector<Evaluation> evaluations;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::optional<Visibility>& of_view = seen[i];
    if (!of_view) continue;
    evaluations.push_back(evaluation(candidate_indices[i], resolutions[resolutions.size() == 1 ? 0 : i], *of_view));
  }
  return evaluations;
}

std::vector<Evaluation> ViewEvaluation::evaluate_until(std::chrono::steady_clock::time_point deadline,
                                                       std::span<const int> candidate_indices,
                                                       std::span<const Resolution> resolutions) const {
  std::vector<Evaluation> evaluations = look_until(deadline, candidate_indices, resolutions);
  score(evaluations);
  return evaluations;
}

std::vector<Evaluation> ViewEvaluation::judge_until(std::chrono::steady_clock::time_point deadline,
                                                    std::vector<Evaluation> evaluations) const {
  score(evaluations, deadline);
  std::erase_if(evaluations, [](const Evaluation& each) { return each.score == not_judged; });
  return evaluations;
}

void rank(std::vector<Evaluation>& evaluations) {
  const bool any_score =
      std::any_of(evaluations.begin(), evaluations.end(), [](const Evaluation& e) { return e.score > 0; });
  std::sort(evaluations.begin(), evaluations.end(), [any_score](const Evaluation& a, const Evaluation& b) {
    if (any_score && a.score != b.score) return a.score > b.score;
    if (!any_score && a.seen.occplane != b.seen.occplane) return a.seen.occplane > b.seen.occplane;
    return a.candidate < b.candidate;
  });
}

std::vector<Evaluation> exhaustive_search(const ViewEvaluation& problem, std::span<const int> feasible,
                                          const RayChoice& rays) {
  std::vector<Resolution> resolutions;
  resolutions.reserve(feasible.size());
  for (const int candidate : feasible) resolutions.push_back(problem.resolution(candidate, rays));
  std::vector<Evaluation> evaluations = problem.evaluate(feasible, resolutions);
  rank(evaluations);
  return evaluations;
}

}  // namespace vantage
