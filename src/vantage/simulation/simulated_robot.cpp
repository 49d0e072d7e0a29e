#include "vantage/simulation/simulated_robot.hpp"

#include <Eigen/Eigenvalues>

namespace vantage {
namespace {

constexpr int most_draws = 1000;
constexpr std::uint64_t error_stream = 1;

/// A matrix whose product with its transpose is the covariance; diagonal where the covariance is, so that each axis
/// keeps its own random numbers.
Mat3 root_of(const PositioningError& error) {
  if (error.is_diagonal()) return Vec3(error.covariance.diagonal().cwiseSqrt()).asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(error.covariance);
  return solver.eigenvectors() * Vec3(solver.eigenvalues().cwiseMax(0).cwiseSqrt()).asDiagonal();
}

}  // namespace

void SimulatedRobotOptions::validate() const { error.validate(); }

SimulatedRobot::SimulatedRobot(const RangeScanner& scanner, const RangeCamera& camera,
                               const SimulatedRobotOptions& options, std::uint64_t seed,
                               std::function<bool(const View&)> can_be_at)
    : scanner_(scanner),
      camera_(camera),
      options_(options),
      error_random_(seed, error_stream),
      can_be_at_(std::move(can_be_at)) {
  options_.validate();
  root_ = root_of(options_.error);
}

View SimulatedRobot::erroneous(const View& commanded) {
  View view = commanded;
  view.world_from_sensor.translation() += options_.error.mean + root_ * error_random_.normal3();
  return view;
}

bool SimulatedRobot::move_to(const View& view) {
  const bool exact = options_.error.is_zero() || (options_.first_pose_exact && moves_ == 0);
  View reached = exact ? view : erroneous(view);
  for (int draw = 1; !can_be_at_(reached); ++draw) {
    if (exact || draw == most_draws) return false;
    reached = erroneous(view);
  }
  ++moves_;
  believed_ = view;
  true_ = reached;
  return true;
}

RangeImage SimulatedRobot::take_range_image() { return scanner_.scan(camera_, true_); }

}  // namespace vantage
