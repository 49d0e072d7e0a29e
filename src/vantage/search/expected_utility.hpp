#pragma once

#include <span>
#include <vector>

#include "vantage/robot/error_model.hpp"
#include "vantage/robot/reach.hpp"
#include "vantage/search/convolution.hpp"
#include "vantage/search/search.hpp"

namespace vantage {

struct ExpectationOptions {
  int candidates = 12;          // the strongest views, which are asked about
  int samples = 32;             // poses around each of them; even, at least 12
  double least_overlap = 0.10;  // n_oc / (n_oc + n_op + n_um) from which a scan counts as one that can be registered

  void validate() const;
};

/// A pose that a move may end at.
struct PossiblePose {
  View view;
  double weight = 1;
  bool reachable = true;  // otherwise it counts in the weight alone: utility 0, no overlap
};

/// sum of weight * utility over the poses, with what the sensor would see from each of them, and the weight of those
/// that overlap enough. With the cells of a view cube around a candidate as poses and eq. 19 as weights this is
/// convolution after evaluation (eq. 20). All sets in one parallel evaluation; `resolutions` one per set.
[[nodiscard]] std::vector<Expectation> expect(const ViewEvaluation& problem,
                                              std::span<const std::vector<PossiblePose>> sets,
                                              std::span<const Resolution> resolutions, double least_overlap);

/// What the planner knows of a robot that errs.
struct ErringRobot {
  const PoseErrorModel& error;
  const VoxelMap& map;
  const ReachOptions& reach;
};

/// Evaluates the strongest of the ranked views again from sampled poses around them and ranks those by expected
/// utility.
[[nodiscard]] std::vector<Evaluation> rank_by_samples(const ViewEvaluation& problem, std::vector<Evaluation> ranked,
                                                      const ErringRobot& robot, const ExpectationOptions& options);

/// Convolution after evaluation of all candidates: ranks by the convolved utilities. `evaluations` holds every feasible
/// candidate. The orientation counts as certain.
[[nodiscard]] std::vector<Evaluation> rank_by_convolution(const ViewEvaluation& problem,
                                                          std::vector<Evaluation> evaluations,
                                                          const PoseErrorModel& error,
                                                          const ConvolutionOptions& options);

}  // namespace vantage
