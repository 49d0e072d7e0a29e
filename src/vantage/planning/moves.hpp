#pragma once

#include <functional>
#include <memory>

#include "vantage/planning/planner.hpp"

namespace vantage {

/// The robot's part in one plan: which candidates it can reach from where it is, what moves cost, and the way to the
/// best view. The map must outlive it and not change meanwhile.
class Moves {
 public:
  /// `travel` counts the length of moves for which no path is asked.
  Moves(const PlannerOptions& options, const Candidates& candidates, const Travel& travel, const VoxelMap& map,
        RobotState from);

  /// Why each candidate is out, in the order of their indices: the caller's reason where it has one, else the robot's.
  [[nodiscard]] std::vector<std::optional<std::string>> why_excluded(
      const std::function<std::optional<std::string>(int)>& callers_reason) const;
  /// The move to a candidate; without a model of the robot it has no path.
  [[nodiscard]] Move to(int candidate) const;

  /// Takes the costs of moves to these candidates as they are known before any path is planned, and returns x of eq. 10
  /// for every candidate: the cost over the largest of them. Empty where the travel is not asked to count so.
  [[nodiscard]] std::vector<double> normalised_costs(const std::vector<int>& feasible);
  /// Costs are counted as in an earlier plan from here, whose largest_cost() this is: views that fell out since then
  /// change nothing about the others.
  void normalise_by(double largest_cost) { largest_cost_ = largest_cost; }
  [[nodiscard]] double largest_cost() const { return largest_cost_; }

  /// Plans the way to the front of the ranking. Where that costs more than was known, `evaluated_anew` is asked for the
  /// evaluation with the new x of eq. 10 and the view takes its new place; where there is no way, the view falls out
  /// with the reason. Ends with a front that the robot gets to, or with an empty ranking.
  void settle(Plan& plan, const std::function<Evaluation(const Evaluation&, double)>& evaluated_anew) const;

 private:
  [[nodiscard]] double normalised(double cost) const;

  const PlannerOptions& options_;
  const Candidates& candidates_;
  Travel travel_;
  std::unique_ptr<Mobility> mobility_;  // none without a model of the robot
  RobotState from_;
  double largest_cost_ = 0;
};

/// Marks a view as one that fell out.
[[nodiscard]] Evaluation infeasible(int candidate, const View& view, const std::string& reason);

}  // namespace vantage
