#include "vantage/simulation/simulated_robot.hpp"

#include <Eigen/Eigenvalues>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr int most_draws = 1000;

// Random numbers of a move: one stream for its error and one for its scan.
Random error_stream(std::uint64_t seed, std::uint64_t move) { return Random(seed, 2 * move); }
Random noise_stream(std::uint64_t seed, std::uint64_t move) { return Random(seed, 2 * move + 1); }

/// A matrix whose product with its transpose is the covariance; diagonal where the covariance is, so that each axis
/// keeps its own random numbers.
Mat3 root_of(const PositioningError& error) {
  if (error.is_diagonal()) return Vec3(error.covariance.diagonal().cwiseSqrt()).asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(error.covariance);
  // Rounding may leave eigenvalues a little below zero where the covariance is singular.
  return axes.eigenvectors() * Vec3(axes.eigenvalues().cwiseMax(0).cwiseSqrt()).asDiagonal();
}

}  // namespace

PositioningErrorModel::PositioningErrorModel(const PositioningError& error) : mean_(error.mean) {
  error.validate();
  root_ = root_of(error);
}

View PositioningErrorModel::perturb(const View& commanded, Random& random) const {
  View reached = commanded;
  reached.world_from_sensor.translation() += mean_ + root_ * random.normal3();
  return reached;
}

void SimulatedRobotOptions::validate() const {
  error.validate();
  depth_noise.validate();
}

SimulatedRobot::SimulatedRobot(const RangeScanner& scanner, const RangeCamera& camera,
                               const SimulatedRobotOptions& options, std::uint64_t seed,
                               std::function<bool(const View&)> can_be_at)
    : scanner_(scanner),
      camera_(camera),
      options_(options),
      error_(options.error),
      seed_(seed),
      can_be_at_(std::move(can_be_at)) {
  camera_.validate();
  options_.validate();
}

bool SimulatedRobot::move_to(const View& view) {
  if (!can_be_at_(view)) return false;
  const std::uint64_t move = moves_ + 1;
  const bool is_exact = options_.error.is_zero() || (options_.first_pose_exact && move == 1);
  View reached = view;
  if (!is_exact) {
    Random random = error_stream(seed_, move);
    int draws = 0;
    do {
      if (++draws > most_draws) return false;
      reached = error_.perturb(view, random);
    } while (!can_be_at_(reached));
  }
  moves_ = move;
  believed_ = view;
  true_ = reached;
  return true;
}

RangeImage SimulatedRobot::take_range_image() {
  require(moves_ > 0, "simulated robot: move_to a view before taking a range image");
  Random random = noise_stream(seed_, moves_);
  return noisy(scanner_.scan(camera_, true_), options_.depth_noise, random);
}

}  // namespace vantage
