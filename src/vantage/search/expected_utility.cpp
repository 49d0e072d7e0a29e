#include "vantage/search/expected_utility.hpp"

#include <algorithm>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/search/pose_samples.hpp"

namespace vantage {
namespace {

std::vector<PossiblePose> poses_around(const View& commanded, const View& current, const ErringRobot& robot,
                                       int samples) {
  std::vector<PossiblePose> poses;
  for (const PoseSample& sample : pose_samples(robot.error.of_move(current, commanded), samples)) {
    const View view = displaced(commanded, sample.error);
    poses.push_back({view, sample.weight, !why_infeasible(robot.map, view, robot.reach)});
  }
  return poses;
}

/// The same question about other views.
ViewEvaluation asked_of(const ViewEvaluation& problem, const Candidates& views) {
  return {problem.map,
          problem.visibility,
          problem.camera,
          views,
          problem.voxel_length,
          problem.travel,
          problem.current,
          problem.options,
          problem.utility,
          {},
          problem.scanned,
          problem.seed,
          {},
          problem.refused};
}

}  // namespace

void ExpectationOptions::validate() const {
  require(candidates >= 1, "error-candidates = ", candidates, ": must be at least 1");
  require(samples >= 12 && samples <= 4096 && samples % 2 == 0, "error-samples = ", samples,
          ": must be an even number in 12..4096");
  require(least_overlap >= 0 && least_overlap <= 1, "least-overlap = ", least_overlap, ": must be a share in [0, 1]");
}

std::vector<Expectation> expect(const ViewEvaluation& problem, std::span<const std::vector<PossiblePose>> sets,
                                std::span<const Resolution> resolutions, double least_overlap) {
  require(resolutions.size() == sets.size(), "expected utility: ", resolutions.size(), " resolutions for ", sets.size(),
          " sets of poses");
  Candidates reachable;
  reachable.center = problem.candidates.center;
  std::vector<Resolution> rays;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (const PossiblePose& pose : sets[i]) {
      if (!pose.reachable) continue;
      reachable.views.push_back(pose.view);
      rays.push_back(resolutions[i]);
    }
  }
  if (problem.utility.needs_all_views) {
    // It says what poses are worth among the feasible candidates, not among each other.
    for (const int candidate : problem.feasible) {
      reachable.views.push_back(problem.candidates.views[static_cast<std::size_t>(candidate)]);
      rays.push_back(problem.ideal(candidate));
    }
  }
  std::vector<int> all(reachable.views.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<Evaluation> evaluations = asked_of(problem, reachable).evaluate(all, rays);

  std::vector<Expectation> expectations(sets.size());
  auto next = evaluations.begin();
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (const PossiblePose& pose : sets[i]) {
      ++expectations[i].samples;
      if (!pose.reachable) continue;
      expectations[i].utility += pose.weight * next->utility;
      if (next->factors.x_oc >= least_overlap) expectations[i].registers += pose.weight;
      ++next;
    }
  }
  return expectations;
}

std::vector<Evaluation> rank_by_samples(const ViewEvaluation& problem, std::vector<Evaluation> ranked,
                                        const ErringRobot& robot, const ExpectationOptions& options) {
  ranked.resize(std::min(ranked.size(), static_cast<std::size_t>(options.candidates)));
  std::vector<std::vector<PossiblePose>> sets;
  std::vector<Resolution> resolutions;
  for (const Evaluation& each : ranked) {
    sets.push_back(poses_around(each.view, problem.current, robot, options.samples));
    resolutions.push_back(each.resolution);
  }
  const std::vector<Expectation> expected = expect(problem, sets, resolutions, options.least_overlap);
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    ranked[i].expected = expected[i];
    ranked[i].score = expected[i].utility;
  }
  rank(ranked);
  return ranked;
}

std::vector<Evaluation> rank_by_convolution(const ViewEvaluation& problem, std::vector<Evaluation> evaluations,
                                            const PoseErrorModel& error, const ConvolutionOptions& options) {
  const Candidates& candidates = problem.candidates;
  std::vector<double> utilities(candidates.views.size(), 0.0);
  for (const Evaluation& each : evaluations) utilities[static_cast<std::size_t>(each.candidate)] = each.utility;
  std::vector<double> expected;
  if (error.is_constant()) {
    expected = convolve(utilities, candidates, error.of_move(problem.current, problem.current).position(), options);
  } else {
    std::vector<PositioningError> errors;
    errors.reserve(candidates.views.size());
    for (const View& view : candidates.views) errors.push_back(error.of_move(problem.current, view).position());
    expected = convolve_each(utilities, candidates, errors, options);
  }
  for (Evaluation& each : evaluations) each.score = expected[static_cast<std::size_t>(each.candidate)];
  rank(evaluations);
  return evaluations;
}

}  // namespace vantage
