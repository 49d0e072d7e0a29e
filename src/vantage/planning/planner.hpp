#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "vantage/planning/registrability.hpp"
#include "vantage/robot/reach.hpp"
#include "vantage/robot/robot_model.hpp"
#include "vantage/search/expected_utility.hpp"
#include "vantage/search/search.hpp"
#include "vantage/utility/registry.hpp"
#include "vantage/utility/tour.hpp"

namespace vantage {

enum class SearchKind { exhaustive, multi_resolution };

/// How a plan allows for the robot's error (docs/positioning-error.md).
enum class ErrorMethod {
  convolution,  // section 7, position alone; needs the exhaustive search, which alone evaluates every view
  samples       // looks from sampled poses around the strongest views, position and orientation
};

struct PlannerOptions {
  SearchKind search = SearchKind::exhaustive;
  RayChoice rays;  // of the exhaustive search
  MultiResolutionOptions multi_resolution;
  std::string utility = "combined";  // see utility_by_name
  TourOptions tour;                  // of the utility `tour`
  bool tells_tour = false;           // plans say the rest of the scan too, where the utility plans it
  UtilityOptions factors;
  ReachOptions reach;
  /// The robot, besides `reach`: only views that it can reach are planned, each with the way there. None: a free flyer
  /// whose paths are not asked for.
  std::shared_ptr<const RobotModel> robot;
  /// What moves are counted by; by default orthodromic on a sphere and straight elsewhere. Asked for, `straight` and
  /// `path` give eq. 10 the cost of a move over that of the largest direct one among the feasible views; `path` without
  /// a robot takes a free flyer. Where the robot's error is planned for, `path` ranks by direct costs.
  std::optional<TravelKind> travel;
  /// How the robot errs as far as the planner knows; without it views are ranked as if the robot were perfect.
  std::shared_ptr<const PoseErrorModel> believed_error;
  ErrorMethod error_method = ErrorMethod::convolution;
  ConvolutionOptions convolution;
  ExpectationOptions expectation;
  /// Where scans have to be registered: views are ranked by utility times the probability of that. With a deadline
  /// there is no time for it.
  std::optional<RegistrabilityOptions> registrability;
  int stop_occplane = 0;  // stop when no feasible view sees more occplane voxels than this
  /// Milliseconds after which a plan is made of the views evaluated until then (search_until); 0: evaluate all. Needs
  /// the exhaustive search without the robot's error. What is planned then depends on the clock.
  double deadline = 0;
  std::uint64_t seed = 1;  // of utilities that draw

  void validate() const;
  /// What the options judge views by. Throws InputError naming the option.
  [[nodiscard]] Utility make_utility() const;
};

/// The next best view with all that led to it.
struct Plan {
  Evaluation best;
  Move move;                           // how the robot gets there; without a path where no model of the robot is given
  std::vector<Evaluation> ranking;     // views that were evaluated to the end, best first
  std::vector<Evaluation> infeasible;  // candidates that fell out, with the reason
  std::size_t feasible = 0;            // candidates that could be chosen; more than are ranked where time ran out
  double largest_cost = 0;             // of moves to them, which x of eq. 10 refers to; 0 where it is an angle
  std::string explanation;             // one sentence for people
  std::vector<TourStop> tour;          // the rest of the scan, where it was asked for; the best view need not be its
                                       // first where the robot cannot get there
};

/// Plans one view after the other (paper, sections 3 to 6): feasible, evaluate, rank, explain.
class Planner {
 public:
  Planner(Candidates candidates, const RangeCamera& camera, const PlannerOptions& options = {});
  /// With a utility of one's own instead of the one that the options name.
  Planner(Candidates candidates, const RangeCamera& camera, const PlannerOptions& options, Utility utility);

  /// The best view to take next from `current`, or nothing where no feasible view meets an occplane voxel any more;
  /// why_finished() then says so.
  [[nodiscard]] std::optional<Plan> next_best_view(const VoxelMap& map, const View& current);
  /// For a plan whose best view turned out to be out of reach: discards that view and takes the next in rank from the
  /// same `current` and map. Nothing where none that is left in the ranking is of use; next_best_view() then knows
  /// whether others are.
  [[nodiscard]] std::optional<Plan> next_in_rank(const VoxelMap& map, const View& current, Plan plan,
                                                 const std::string& reason);
  /// Why each candidate is not feasible now, or nothing where it is.
  [[nodiscard]] std::vector<std::optional<std::string>> why_infeasible_now(const VoxelMap& map,
                                                                           const View& current) const;
  /// Brings the robot's model to a candidate from where it waits; what is in the way of that, or nothing.
  [[nodiscard]] std::optional<std::string> begin_at(const VoxelMap& map, int candidate);
  /// The robot has made the plan's move: the next one begins where it ends.
  void arrived(const Plan& plan);
  /// What the plan's move counts in the sum of distances: the cost of its path where the travel is asked to be that,
  /// else the distance between the positions.
  [[nodiscard]] double distance_of(const Plan& plan, const Vec3& from) const;

  /// The robot cannot reach this candidate: it is not planned again.
  void discard(int candidate, const std::string& reason);
  /// This candidate's scan could not be used: it is not planned again until the map changes.
  void set_aside(int candidate, const std::string& reason);
  void map_changed() { set_aside_.clear(); }
  /// From now on the robot is believed to err like this. Nothing changes where errors are not planned for: neither by
  /// what they leave of the utility nor by whether scans can be registered.
  void believe(const PoseError& error);
  /// A scan from this view was merged. `candidate` is -1 where it is none of the candidates.
  void scanned(const View& view, int candidate);

  [[nodiscard]] const std::string& why_finished() const { return why_finished_; }
  [[nodiscard]] const Candidates& candidates() const { return candidates_; }
  [[nodiscard]] const RangeCamera& camera() const { return camera_; }
  [[nodiscard]] const PlannerOptions& options() const { return options_; }
  /// How the length of moves between the candidates is counted where no path is asked: by default orthodromic on a
  /// sphere, straight elsewhere.
  [[nodiscard]] Travel travel() const;

 private:
  [[nodiscard]] std::optional<std::string> why_excluded(const VoxelMap& map, int candidate) const;
  [[nodiscard]] std::vector<Evaluation> search(const ViewEvaluation& problem, const std::vector<int>& feasible,
                                               std::chrono::steady_clock::time_point start) const;
  /// Where the robot is that has its sensor at `current`.
  [[nodiscard]] RobotState state_behind(const View& current) const;
  [[nodiscard]] std::optional<Plan> finished();
  /// For why_finished(): which views were left out because their scans failed; empty where there are none.
  [[nodiscard]] std::string what_is_set_aside() const;
  /// Ranks by the probability of being registered too; nothing where no view with a fair chance is left.
  [[nodiscard]] std::optional<Plan> registrable(Plan plan, const ViewEvaluation& problem,
                                                const RegistrabilityOptions& options);
  /// Settles on the best view of the ranking that the robot gets to.
  [[nodiscard]] std::optional<Plan> settled(Plan plan, const class Moves& moves, const ViewEvaluation& problem);
  void expect_errors(Plan& plan, const ViewEvaluation& problem, const VoxelMap& map) const;

  Candidates candidates_;
  RangeCamera camera_;
  PlannerOptions options_;
  Utility utility_;
  std::map<int, std::string> discarded_, set_aside_;
  std::vector<View> scanned_;
  std::set<int> scanned_candidates_;
  std::string why_finished_;
  std::optional<RobotState> state_;  // after the last move that was planned
};

}  // namespace vantage
