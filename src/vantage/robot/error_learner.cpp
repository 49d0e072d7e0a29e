#include "vantage/robot/error_learner.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/robot/error_limits.hpp"

namespace vantage {
namespace {

constexpr double deviation_over_median = 1.4826;  // of a normal distribution: sigma over the median of |x - median|

/// Posterior of three entries that err together, from entry `first` on.
struct Block {
  Vec3 mean = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};

Block posterior(const std::vector<PoseError::Vector>& differences, int first, const Vec3& prior_deviations,
                const ErrorLearnerOptions& options) {
  const auto count = static_cast<double>(differences.size());
  Vec3 average = Vec3::Zero();
  for (const PoseError::Vector& each : differences) average += each.segment<3>(first) / count;
  Mat3 scatter = Mat3::Zero();
  for (const PoseError::Vector& each : differences) {
    const Vec3 deviation = each.segment<3>(first) - average;
    scatter += deviation * deviation.transpose();
  }
  const double kappa = options.prior_mean_weight + count;
  const Mat3 prior = prior_deviations.cwiseAbs2().asDiagonal();
  Block block;
  block.mean = count / kappa * average;
  block.covariance = (options.prior_covariance_weight * prior + scatter +
                      options.prior_mean_weight * count / kappa * average * average.transpose()) /
                     (options.prior_covariance_weight + count);
  return block;
}

}  // namespace

void ErrorLearnerOptions::validate() const {
  require((prior_deviation.array() > 0).all() && (prior_deviation.array() <= largest_position_error).all(),
          "learning the error: prior deviation = ", prior_deviation.transpose(), " m: must be positive, at most ",
          largest_position_error);
  for (const auto& [name, value] : {std::pair{"orientation", prior_orientation},
                                    {"mean weight", prior_mean_weight},
                                    {"covariance weight", prior_covariance_weight}}) {
    require(value > 0 && std::isfinite(value), "learning the error: prior ", name, " = ", value, ": must be positive");
  }
  require(wild_deviations > 0, "learning the error: wild deviations = ", wild_deviations, ": must be positive");
}

ErrorLearner::ErrorLearner(const ErrorLearnerOptions& options) : options_(options) { options_.validate(); }

void ErrorLearner::add(const View& commanded, const View& registered) {
  const PoseError::Vector difference = error_between(commanded, registered);
  require(difference.allFinite(), "learning the error: the registered pose has an entry that is not a finite number");
  differences_.push_back(difference);
}

PoseError::Vector ErrorLearner::prior_deviations() const {
  PoseError::Vector deviations;
  deviations << options_.prior_deviation, Vec3::Constant(options_.prior_orientation);
  return deviations;
}

std::vector<PoseError::Vector> ErrorLearner::plausible() const {
  if (differences_.empty()) return {};
  PoseError::Vector middle;
  PoseError::Vector limit;
  const PoseError::Vector least = prior_deviations();
  for (int axis = 0; axis < 6; ++axis) {
    std::vector<double> values;
    values.reserve(differences_.size());
    for (const PoseError::Vector& each : differences_) values.push_back(each[axis]);
    middle[axis] = median(values);
    for (double& value : values) value = std::abs(value - middle[axis]);
    limit[axis] = options_.wild_deviations * std::max(deviation_over_median * median(values), least[axis]);
  }
  std::vector<PoseError::Vector> kept;
  for (const PoseError::Vector& each : differences_) {
    if (((each - middle).cwiseAbs().array() <= limit.array()).all()) kept.push_back(each);
  }
  return kept;
}

int ErrorLearner::left_out() const { return observations() - static_cast<int>(plausible().size()); }

PoseError ErrorLearner::estimate() const {
  const std::vector<PoseError::Vector> differences = plausible();
  const Block position = posterior(differences, 0, options_.prior_deviation, options_);
  const Block orientation = posterior(differences, 3, Vec3::Constant(options_.prior_orientation), options_);
  PoseError error;
  error.mean << position.mean, orientation.mean;
  error.covariance.topLeftCorner<3, 3>() = position.covariance;
  error.covariance.bottomRightCorner<3, 3>() = orientation.covariance;
  return error;
}

PoseError ErrorLearner::prediction() const {
  PoseError error = estimate();
  const double kappa = options_.prior_mean_weight + static_cast<double>(plausible().size());
  error.covariance *= (kappa + 1) / kappa;
  return error;
}

}  // namespace vantage
