#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "vantage/candidates/candidates.hpp"
#include "vantage/robot/travel.hpp"
#include "vantage/utility/utility.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage {

/// Which rays a view is evaluated with.
struct RayChoice {
  enum class Kind { sensor, ideal, fixed };
  Kind kind = Kind::sensor;
  Resolution resolution;  // for `fixed`

  void validate() const;
};

/// What a view is worth to a robot that errs.
struct Expectation {
  double utility = 0;    // mean over the poses that the move may end at
  double registers = 0;  // probability that the scan overlaps enough with what is known to be registered
  int samples = 0;       // poses
};

/// How well the pose of a view's scan could be found once it is taken (planning/registrability.hpp).
struct Registrability {
  double probability = 1;   // that the object's surface ends up less than half a voxel off
  double misplacement = 0;  // expected: root of the mean squared distance along the normals, metres
};

/// One candidate view with all that was found out about it.
struct Evaluation {
  int candidate = -1;
  View view;
  bool feasible = true;
  std::string reason;     // why it is infeasible
  Resolution resolution;  // of the rays it was evaluated with; 0x0: not evaluated
  Visibility seen;
  Factors factors;
  double utility = 0;
  double score = 0;                     // what the ranking goes by: the utility, or what the robot's error leaves of it
  std::optional<Expectation> expected;  // where poses around the view were sampled
  std::optional<Registrability> registrability;  // where the scan has to be registered

  [[nodiscard]] bool evaluated() const { return resolution.rays() > 0; }
};

/// All that the evaluation of views at one moment needs.
struct ViewEvaluation {
  const VoxelMap& map;
  const VisibilityEvaluator& visibility;
  const RangeCamera& camera;
  const Candidates& candidates;
  double voxel_length;
  Travel travel;
  View current;
  UtilityOptions options;
  Utility utility;
  /// x of eq. 10 per candidate where moves are not counted as `travel` does; else empty.
  std::vector<double> normalised_costs = {};
  std::span<const View> scanned = {};
  std::uint64_t seed = 1;
  /// What a utility that compares views compares with where other views than candidates are asked about.
  std::span<const int> feasible = {};
  int refused = 0;  // as in Choice

  /// The ideal resolution of a candidate (eq. 14), from its distance to the center.
  [[nodiscard]] Resolution ideal(int candidate) const;
  [[nodiscard]] Resolution resolution(int candidate, const RayChoice& rays) const;
  /// Evaluates the given candidates, each with its own resolution, in parallel.
  [[nodiscard]] std::vector<Evaluation> evaluate(std::span<const int> candidate_indices,
                                                 std::span<const Resolution> resolutions) const;
  /// The same in the given order until the deadline, after which no view is begun: only those that were evaluated.
  [[nodiscard]] std::vector<Evaluation> evaluate_until(std::chrono::steady_clock::time_point deadline,
                                                       std::span<const int> candidate_indices,
                                                       std::span<const Resolution> resolutions) const;
  /// What views see, without scores, in the given order until the deadline: only those that were looked at.
  [[nodiscard]] std::vector<Evaluation> look_until(std::chrono::steady_clock::time_point deadline,
                                                   std::span<const int> candidate_indices,
                                                   std::span<const Resolution> resolutions) const;
  /// Scores them until the deadline, the first ones first: only those that the utility had time for.
  [[nodiscard]] std::vector<Evaluation> judge_until(std::chrono::steady_clock::time_point deadline,
                                                    std::vector<Evaluation> evaluations) const;
  /// The rest of the scan over these views, where the utility plans that; else empty.
  [[nodiscard]] std::vector<TourStop> tour(const std::vector<Evaluation>& evaluations) const;
  /// The same view where the move there has another x of eq. 10.
  [[nodiscard]] Evaluation with_cost(Evaluation evaluation, double normalised_cost) const;

 private:
  [[nodiscard]] Evaluation evaluation(int candidate, Resolution resolution, const Visibility& seen) const;
  [[nodiscard]] std::vector<ViewToJudge> to_judge(const std::vector<Evaluation>& evaluations) const;
  [[nodiscard]] Choice choice(std::span<const ViewToJudge> views,
                              std::optional<std::chrono::steady_clock::time_point> deadline) const;
  /// Fills in utility and score.
  void score(std::vector<Evaluation>& evaluations,
             std::optional<std::chrono::steady_clock::time_point> deadline = {}) const;
  /// x of eq. 10 for the move to a candidate.
  [[nodiscard]] double normalised_cost(int candidate) const;
  [[nodiscard]] std::vector<View> views_of(std::span<const int> candidate_indices) const;
};

/// Descending score, ties by the lower candidate; where no score is above 0, descending n_op (spec, section 4).
void rank(std::vector<Evaluation>& evaluations);

/// Every feasible candidate with the same kind of rays, ranked.
[[nodiscard]] std::vector<Evaluation> exhaustive_search(const ViewEvaluation& problem, std::span<const int> feasible,
                                                        const RayChoice& rays);

struct MultiResolutionOptions {
  int b = 10;                 // eq. 16
  std::optional<int> stages;  // k; by default the smallest with b^k >= |V|
  int min_columns = 40;       // R_min

  void validate() const;
};

/// k of Algorithm 2: the smallest k >= 1 with b^k >= `views`.
[[nodiscard]] int number_of_stages(int views, int b);
/// R_i, eq. 15, for stage i = 1..k.
[[nodiscard]] Resolution stage_resolution(Resolution ideal, int min_columns, int stage, int stages);

/// Algorithm 2: the views of the last stage, ranked.
[[nodiscard]] std::vector<Evaluation> multi_resolution_search(const ViewEvaluation& problem,
                                                              std::span<const int> feasible,
                                                              const MultiResolutionOptions& options);

}  // namespace vantage
