#include "vantage/planning/planner.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/planning/moves.hpp"
#include "vantage/robot/free_flyer.hpp"
#include "vantage/search/timed_search.hpp"

namespace vantage {
namespace {

double per_cent(double share) { return std::round(1000 * share) / 10; }

bool meets_occplane(const std::vector<Evaluation>& evaluations, int at_most) {
  return std::any_of(evaluations.begin(), evaluations.end(),
                     [at_most](const Evaluation& e) { return e.seen.occplane > at_most; });
}

/// Of how many views it is the best, and how many there was no time for.
std::string rivals(const Plan& plan, double deadline) {
  const std::size_t seen = plan.ranking.size();
  // Poses are sampled only around the strongest views, and only those are
  // or asked whether their scans can be registered.
  if ((plan.best.expected || plan.best.registrability) && seen < plan.feasible)
    return concat("best of the ", seen, " strongest of ", plan.feasible);
  if (deadline == 0 || seen == plan.feasible) return concat("best of ", seen);
  return concat("best of the ", seen, " of ", plan.feasible, " views seen within ", deadline, " ms");
}

std::string describe(const Expectation& expected, double utility) {
  return concat("; with the robot's error its utility of ", std::round(1000 * utility) / 1000, " is expected to be ",
                std::round(1000 * expected.utility) / 1000, ", and the scan to overlap enough to be registered with ",
                "probability ", std::round(100 * expected.registers), " % (", expected.samples, " poses)");
}

std::string describe(const Registrability& expected) {
  return concat("; its scan is expected to be registered with probability ", std::round(100 * expected.probability),
                " %, the surface then ", std::round(1e4 * expected.misplacement) / 10, " mm off");
}

std::string explain(const Evaluation& best, const std::string& rivals, double angle) {
  return concat(rivals, ": meets ", best.seen.occplane, " occplane voxels (", per_cent(best.factors.x_op),
                " % of what it sees), overlaps with ", best.seen.occupied, " occupied ones (",
                per_cent(best.factors.x_oc), " %), ", std::round(degrees(angle)), " degrees from here",
                best.expected ? describe(*best.expected, best.utility) : "",
                best.registrability ? describe(*best.registrability) : "");
}

}  // namespace

void PlannerOptions::validate() const {
  rays.validate();
  multi_resolution.validate();
  factors.validate();
  reach.validate();
  require(stop_occplane >= 0, "stop-occplane = ", stop_occplane, ": must not be negative");
  require(deadline >= 0 && std::isfinite(deadline), "deadline = ", deadline,
          " ms: must be positive, or 0 for no deadline");
  require(deadline == 0 || search == SearchKind::exhaustive, "deadline = ", deadline,
          " ms: needs the exhaustive search, because multi-resolution has no result before its last stage; leave one "
          "of them out");
  require(deadline == 0 || !believed_error, "deadline = ", deadline,
          " ms: planning with the robot's error (convolve) needs the utility of every view; leave one of them out");
  (void)make_utility();
  convolution.validate();
  expectation.validate();
  if (registrability) registrability->validate();
  if (!believed_error || error_method != ErrorMethod::convolution) return;
  require(search == SearchKind::exhaustive,
          "convolution after evaluation needs the utility of every view: use it with the exhaustive search, "
          "not with multi-resolution, which evaluates only some views to the end; sampled poses go with both");
}

Utility PlannerOptions::make_utility() const {
  return utility == "tour" ? tour_utility(tour) : utility_by_name(utility);
}

Planner::Planner(Candidates candidates, const RangeCamera& camera, const PlannerOptions& options)
    : Planner(std::move(candidates), camera, options, options.make_utility()) {}

Planner::Planner(Candidates candidates, const RangeCamera& camera, const PlannerOptions& options, Utility utility)
    : candidates_(std::move(candidates)), camera_(camera), options_(options), utility_(std::move(utility)) {
  camera_.validate();
  options_.validate();
  require(!candidates_.views.empty(), "candidates: there are none");
  require(!utility_.needs_all_views || options_.search == SearchKind::exhaustive, "utility '", options_.utility,
          "' compares all views: use it with the exhaustive search, not with multi-resolution, whose stages drop the "
          "views that "
          "it would compare with; a deadline bounds its time");
  require(options_.travel != TravelKind::orthodromic || candidates_.kind == Candidates::Kind::sphere,
          "travel = orthodromic: needs candidates on a sphere; use straight or path");
  // The navigation factor is made for a sphere (spec, section 4), unless the user says what moves are counted by.
  if (candidates_.kind == Candidates::Kind::grid && !options_.travel) options_.factors.navigation = false;
  if (options_.travel == TravelKind::path && !options_.robot) {
    options_.robot = std::make_shared<FreeFlyer>(options_.reach);
  }
}

Travel Planner::travel() const {
  Travel travel;
  travel.center = candidates_.center;
  if (candidates_.kind == Candidates::Kind::sphere &&
      options_.travel.value_or(TravelKind::orthodromic) == TravelKind::orthodromic) {
    travel.path = Travel::Path::orthodromic;
    travel.radius = (candidates_.views.front().position() - candidates_.center).norm();
  }
  return travel;
}

std::optional<std::string> Planner::why_excluded(const VoxelMap& map, int candidate) const {
  if (const auto found = discarded_.find(candidate); found != discarded_.end()) return found->second;
  if (const auto found = set_aside_.find(candidate); found != set_aside_.end()) return found->second;
  if (utility_.skips_scanned_views && scanned_candidates_.count(candidate) > 0) return "has been scanned from";
  return why_infeasible(map, candidates_.views[static_cast<std::size_t>(candidate)], options_.reach);
}

std::vector<Evaluation> Planner::search(const ViewEvaluation& problem, const std::vector<int>& feasible,
                                        std::chrono::steady_clock::time_point start) const {
  if (options_.deadline > 0) {
    const auto time = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double, std::milli>(std::min(options_.deadline, 1e12)));
    return search_until({start + time, options_.stop_occplane}, problem, feasible, options_.rays);
  }
  if (options_.search == SearchKind::exhaustive) return exhaustive_search(problem, feasible, options_.rays);
  std::vector<Evaluation> ranking = multi_resolution_search(problem, feasible, options_.multi_resolution);
  if (meets_occplane(ranking, options_.stop_occplane)) return ranking;
  // The coarse stages overlook single voxels: ask all views before concluding that nothing is left (spec, section 5).
  return exhaustive_search(problem, feasible, {RayChoice::Kind::ideal, {}});
}

void Planner::expect_errors(Plan& plan, const ViewEvaluation& problem, const VoxelMap& map) const {
  const ErringRobot robot{*options_.believed_error, map, options_.reach};
  // Where every view has been evaluated, the convolution also finds the strongest ones that are worth sampling.
  if (options_.search == SearchKind::exhaustive) {
    plan.ranking = rank_by_convolution(problem, std::move(plan.ranking), robot.error, options_.convolution);
  }
  if (options_.error_method == ErrorMethod::samples) {
    plan.ranking = rank_by_samples(problem, std::move(plan.ranking), robot, options_.expectation);
  } else {
    plan.ranking.front().expected =
        rank_by_samples(problem, {plan.ranking.front()}, robot, options_.expectation).front().expected;
  }
}

void Planner::believe(const PoseError& error) {
  if (options_.believed_error) options_.believed_error = std::make_shared<ConstantError>(error);
  if (options_.registrability && options_.registrability->error) {
    options_.registrability->error = std::make_shared<ConstantError>(error);
  }
}

std::optional<Plan> Planner::next_best_view(const VoxelMap& map, const View& current) {
  const auto start = std::chrono::steady_clock::now();
  Plan plan;
  Moves moves(options_, candidates_, travel(), map, state_behind(current));
  const auto reasons = moves.why_excluded([&](int candidate) { return why_excluded(map, candidate); });
  std::vector<int> feasible;
  for (int i = 0; i < static_cast<int>(candidates_.views.size()); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (const std::optional<std::string>& reason = reasons[at]) {
      plan.infeasible.push_back(infeasible(i, candidates_.views[at], *reason));
    } else {
      feasible.push_back(i);
    }
  }
  if (feasible.empty()) {
    why_finished_ =
        concat("none of the ", candidates_.views.size(),
               " candidate views is feasible (the first: ", plan.infeasible.front().reason, ")", what_is_set_aside());
    return std::nullopt;
  }

  const VisibilityEvaluator visibility(map);
  const ViewEvaluation problem{map,
                               visibility,
                               camera_,
                               candidates_,
                               map.grid().length,
                               travel(),
                               current,
                               options_.factors,
                               utility_,
                               moves.normalised_costs(feasible),
                               scanned_,
                               options_.seed,
                               feasible,
                               static_cast<int>(set_aside_.size())};
  plan.feasible = feasible.size();
  plan.largest_cost = moves.largest_cost();
  plan.ranking = search(problem, feasible, start);
  if (!meets_occplane(plan.ranking, options_.stop_occplane)) return finished();
  if (options_.tells_tour) plan.tour = problem.tour(plan.ranking);
  if (options_.believed_error) expect_errors(plan, problem, map);
  if (options_.registrability && options_.registrability->error && options_.deadline == 0) {
    std::optional<Plan> ranked = registrable(std::move(plan), problem, *options_.registrability);
    if (!ranked) return std::nullopt;
    plan = *std::move(ranked);
  }
  return settled(std::move(plan), moves, problem);
}

std::optional<Plan> Planner::registrable(Plan plan, const ViewEvaluation& problem,
                                         const RegistrabilityOptions& options) {
  RegistrableViews views = rank_by_registrability(problem, std::move(plan.ranking), options, options_.stop_occplane);
  if (views.ranking.empty()) {
    why_finished_ =
        concat("no view that meets an occplane voxel has a fair chance that its scan can be registered (at best ",
               per_cent(views.best_probability), " %, ", per_cent(options.fair_chance), " % are asked for)",
               what_is_set_aside());
    return std::nullopt;
  }
  plan.ranking = std::move(views.ranking);
  return plan;
}

std::optional<Plan> Planner::finished() {
  why_finished_ = options_.stop_occplane == 0
                      ? "no feasible view meets an occplane voxel any more"
                      : concat("no feasible view meets more than ", options_.stop_occplane, " occplane voxels");
  why_finished_ += what_is_set_aside();
  return std::nullopt;
}

std::string Planner::what_is_set_aside() const {
  if (set_aside_.empty()) return {};
  return concat("; left out are ", set_aside_.size(), set_aside_.size() == 1 ? " view" : " views",
                " whose scans could not be registered since the map changed last");
}

std::optional<Plan> Planner::settled(Plan plan, const Moves& moves, const ViewEvaluation& problem) {
  if (options_.robot) {
    moves.settle(plan, [&problem](const Evaluation& e, double cost) { return problem.with_cost(e, cost); });
    if (!meets_occplane(plan.ranking, options_.stop_occplane)) return finished();
  }
  plan.best = plan.ranking.front();
  plan.explanation =
      explain(plan.best, rivals(plan, options_.deadline),
              angle_seen_from(candidates_.center, problem.current.position(), plan.best.view.position()));
  why_finished_.clear();
  return plan;
}

std::optional<Plan> Planner::next_in_rank(const VoxelMap& map, const View& current, Plan plan,
                                          const std::string& reason) {
  discard(plan.best.candidate, reason);
  plan.infeasible.push_back(infeasible(plan.best.candidate, plan.best.view, reason));
  std::erase_if(plan.ranking, [&](const Evaluation& each) { return each.candidate == plan.best.candidate; });
  std::vector<int> ranked;
  ranked.reserve(plan.ranking.size());
  for (const Evaluation& each : plan.ranking) ranked.push_back(each.candidate);
  if (!meets_occplane(plan.ranking, options_.stop_occplane)) return std::nullopt;
  --plan.feasible;
  plan.move = {};
  Moves moves(options_, candidates_, travel(), map, state_behind(current));
  moves.normalise_by(plan.largest_cost);
  const VisibilityEvaluator visibility(map);
  const ViewEvaluation problem{map,
                               visibility,
                               camera_,
                               candidates_,
                               map.grid().length,
                               travel(),
                               current,
                               options_.factors,
                               utility_,
                               {},
                               scanned_,
                               options_.seed,
                               ranked,
                               static_cast<int>(set_aside_.size())};
  return settled(std::move(plan), moves, problem);
}

std::vector<std::optional<std::string>> Planner::why_infeasible_now(const VoxelMap& map, const View& current) const {
  const Moves moves(options_, candidates_, travel(), map, state_behind(current));
  return moves.why_excluded([&](int candidate) { return why_excluded(map, candidate); });
}

RobotState Planner::state_behind(const View& current) const {
  const auto is_current = [&current](const View& view) {
    return view.world_from_sensor.isApprox(current.world_from_sensor, 1e-9);
  };
  if (state_ && is_current(state_->view)) return *state_;
  if (!options_.robot) return {current};
  if (auto state = options_.robot->state_at(current)) return *state;
  return options_.robot->state_near(current);
}

std::optional<std::string> Planner::begin_at(const VoxelMap& map, int candidate) {
  const View& view = candidates_.views[static_cast<std::size_t>(candidate)];
  if (auto reason = why_excluded(map, candidate)) return reason;
  if (!options_.robot) return std::nullopt;
  const auto mobility = options_.robot->among({map, options_.reach.obstacles});
  if (auto reason = mobility->why_unreachable(view)) return reason;
  const auto home = options_.robot->home();
  if (!home) {
    state_ = options_.robot->state_at(view);
    return std::nullopt;
  }
  const Move move = mobility->move(*home, view);
  if (!move.possible()) return move.why_not;
  state_ = move.path.back();
  return std::nullopt;
}

void Planner::arrived(const Plan& plan) {
  if (plan.move.possible()) state_ = plan.move.path.back();
}

double Planner::distance_of(const Plan& plan, const Vec3& from) const {
  if (options_.travel == TravelKind::path) return plan.move.cost;
  return travel().distance(from, plan.best.view.position());
}

void Planner::scanned(const View& view, int candidate) {
  scanned_.push_back(view);
  if (candidate >= 0) scanned_candidates_.insert(candidate);
}

void Planner::discard(int candidate, const std::string& reason) { discarded_[candidate] = reason; }
void Planner::set_aside(int candidate, const std::string& reason) { set_aside_[candidate] = reason; }

}  // namespace vantage
