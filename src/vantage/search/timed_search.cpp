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

bool any_of_use(const TimeBox& box, const std::vector<Evaluation>& evaluations) {
  return std::any_of(evaluations.begin(), evaluations.end(),
                     [&box](const Evaluation& each) { return each.seen.occplane > box.stop_occplane; });
}

/// As many as there is time for, those that see the most unknown first.
std::vector<Evaluation> looked_at(Clock::time_point until, const ViewEvaluation& problem, std::span<const int> feasible,
                                  const RayChoice& rays) {
  ViewQueue queue(problem.candidates, feasible);
  std::vector<Evaluation> looked;
  for (bool in_time = true; in_time && !queue.empty();) {
    const std::vector<int> round = queue.next(views_per_round(feasible.size()));
    std::vector<Evaluation> found = problem.look_until(until, round, resolutions_of(problem, round, rays));
    in_time = found.size() == round.size();
    for (Evaluation& each : found) each.score = static_cast<double>(each.seen.occplane) + each.seen.unmarked;
    queue.learn(found);
    looked.insert(looked.end(), found.begin(), found.end());
  }
  std::sort(looked.begin(), looked.end(), [](const Evaluation& a, const Evaluation& b) {
    return a.score != b.score ? a.score > b.score : a.candidate < b.candidate;
  });
  return looked;
}

std::vector<Evaluation> compare_until(const TimeBox& box, const ViewEvaluation& problem, std::span<const int> feasible,
                                      const RayChoice& rays) {
  const auto now = Clock::now();
  const std::vector<Evaluation> looked = looked_at(now + (box.deadline - now) / 4, problem, feasible, rays);
  std::vector<Evaluation> judged = problem.judge_until(box.deadline, looked);
  std::vector<int> order;
  order.reserve(feasible.size());
  for (const Evaluation& each : looked) order.push_back(each.candidate);
  for (const int view : feasible) {
    if (std::find(order.begin(), order.end(), view) == order.end()) order.push_back(view);
  }
  for (std::size_t count = views_per_round(order.size()); !any_of_use(box, judged) && judged.size() < order.size();
       count *= 2) {
    const std::span<const int> first(order.data(), std::min(count, order.size()));
    judged = problem.evaluate(first, resolutions_of(problem, first, rays));
  }
  rank(judged);
  return judged;
}

}  // namespace

std::vector<Evaluation> search_until(const TimeBox& box, const ViewEvaluation& problem, std::span<const int> feasible,
                                     const RayChoice& rays) {
  if (problem.utility.needs_all_views) return compare_until(box, problem, feasible, rays);
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
