#include "vantage/planning/moves.hpp"

#include <algorithm>
#include <map>

#include "vantage/core/parallel.hpp"

namespace vantage {

Evaluation infeasible(int candidate, const View& view, const std::string& reason) {
  Evaluation excluded;
  excluded.candidate = candidate;
  excluded.view = view;
  excluded.feasible = false;
  excluded.reason = reason;
  return excluded;
}

Moves::Moves(const PlannerOptions& options, const Candidates& candidates, const Travel& travel, const VoxelMap& map,
             RobotState from)
    : options_(options), candidates_(candidates), travel_(travel), from_(std::move(from)) {
  if (options.robot) mobility_ = options.robot->among({map, options.reach.obstacles});
}

std::vector<std::optional<std::string>> Moves::why_excluded(
    const std::function<std::optional<std::string>(int)>& callers_reason) const {
  std::vector<std::optional<std::string>> reasons(candidates_.views.size());
  const auto ask = [&](std::size_t i) {
    reasons[i] = callers_reason(static_cast<int>(i));
    if (!reasons[i] && mobility_) reasons[i] = mobility_->why_unreachable(candidates_.views[i]);
  };
  if (mobility_) {
    parallel_for(reasons.size(), ask);
  } else {
    for (std::size_t i = 0; i < reasons.size(); ++i) ask(i);
  }
  return reasons;
}

Move Moves::to(int candidate) const {
  return mobility_ ? mobility_->move(from_, candidates_.views[static_cast<std::size_t>(candidate)]) : Move{};
}

std::vector<double> Moves::normalised_costs(const std::vector<int>& feasible) {
  if (!options_.travel || *options_.travel == TravelKind::orthodromic) return {};
  std::vector<double> costs(candidates_.views.size(), 0.0);
  parallel_for(feasible.size(), [&](std::size_t i) {
    const auto candidate = static_cast<std::size_t>(feasible[i]);
    const View& view = candidates_.views[candidate];
    costs[candidate] = *options_.travel == TravelKind::path ? mobility_->least_cost(from_, view)
                                                            : travel_.distance(from_.view.position(), view.position());
  });
  largest_cost_ = *std::max_element(costs.begin(), costs.end());
  for (double& cost : costs) cost = normalised(cost);
  return costs;
}

double Moves::normalised(double cost) const { return largest_cost_ > 0 ? std::min(1.0, cost / largest_cost_) : 0; }

void Moves::settle(Plan& plan, const std::function<Evaluation(const Evaluation&, double)>& evaluated_anew) const {
  if (!mobility_) return;
  std::map<int, Move> planned;
  while (!plan.ranking.empty()) {
    Evaluation& front = plan.ranking.front();
    if (const auto found = planned.find(front.candidate); found != planned.end()) {
      plan.move = std::move(found->second);
      return;
    }
    Move move = to(front.candidate);
    if (!move.possible()) {
      plan.infeasible.push_back(infeasible(front.candidate, front.view, move.why_not));
      plan.ranking.erase(plan.ranking.begin());
      continue;
    }
    if (options_.travel == TravelKind::path && !options_.believed_error) {
      front = evaluated_anew(front, normalised(move.cost));
      planned.emplace(front.candidate, std::move(move));
      rank(plan.ranking);
    } else {
      planned.emplace(front.candidate, std::move(move));
    }
  }
}

}  // namespace vantage
