#include "vantage/search/timed_search.hpp"

#include <algorithm>

#include "vantage/search/view_queue.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

/// Views in each of about eight rounds; enough of them that threads do not wait for each other.
std::size_t views_per_round(std::size_t views) { return std::max<std::size_t>(16, views / 8); }

std::vector<Resolution> resolutions_of(const ViewEvaluation& problem, std::span<const int> views,
                                       const RayChoice& rays) {
  std::vector<Resolution> resolutions;
  resolutions.reserve(views.size());
  for (const int view : views) resolutions.push_back(problem.resolution(view, rays));
  return resolutions;
}

}  // namespace

std::vector<Evaluation> search_until(const TimeBox& box, const ViewEvaluation& problem, std::span<const int> feasible,
                                     const RayChoice& rays) {
  ViewQueue queue(problem.candidates, feasible);
  std::vector<Evaluation> evaluations;
  bool any_of_use = false;
  const auto add = [&](const std::vector<Evaluation>& found) {
    for (const Evaluation& each : found) any_of_use |= each.seen.occplane > box.stop_occplane;
    evaluations.insert(evaluations.end(), found.begin(), found.end());
    queue.learn(found);
  };
  std::vector<int> late;
  while (!queue.empty() && late.empty()) {
    const std::vector<int> round = queue.next(views_per_round(feasible.size()));
    const auto found = problem.evaluate_until(box.deadline, round, resolutions_of(problem, round, rays));
    for (const int view : round) {
      const auto is_view = [view](const Evaluation& each) { return each.candidate == view; };
      if (std::none_of(found.begin(), found.end(), is_view)) late.push_back(view);
    }
    add(found);
  }
  while (!any_of_use && !late.empty()) {
    add(problem.evaluate(late, resolutions_of(problem, late, rays)));
    late = queue.next(views_per_round(feasible.size()));
  }
  rank(evaluations);
  return evaluations;
}

}  // namespace vantage
