#include "vantage/simulation/simulated_robot.hpp"

#include "vantage/core/error.hpp"
#include "vantage/sensor/flying_pixels.hpp"

namespace vantage {
namespace {

constexpr int most_draws = 1000;

// Random numbers of a move: one stream for its error and one for its scan.
Random error_stream(std::uint64_t seed, std::uint64_t move) { return Random(seed, 2 * move); }
Random noise_stream(std::uint64_t seed, std::uint64_t move) { return Random(seed, 2 * move + 1); }

}  // namespace

View perturbed(const View& commanded, const PoseError& error, Random& random) {
  error.validate();
  PoseError::Vector drawn = error.mean;
  if (error.keeps_orientation()) {
    drawn.head<3>() += root_of(error.position().covariance) * random.normal3();
  } else {
    PoseError::Vector normal;
    normal.head<3>() = random.normal3();
    normal.tail<3>() = random.normal3();
    drawn += root_of(error.covariance) * normal;
  }
  return displaced(commanded, drawn);
}

void SimulatedRobotOptions::validate() const { sensor.validate(); }

SimulatedRobot::SimulatedRobot(const RangeScanner& scanner, const RangeCamera& camera,
                               const SimulatedRobotOptions& options, std::uint64_t seed,
                               std::function<bool(const View&)> can_be_at)
    : scanner_(scanner), camera_(camera), options_(options), seed_(seed), can_be_at_(std::move(can_be_at)) {
  camera_.validate();
  options_.validate();
}

bool SimulatedRobot::move_to(const View& view) {
  if (!can_be_at_(view)) return false;
  const std::uint64_t move = moves_ + 1;
  View reached = view;
  const bool is_exact = !options_.error || (options_.first_pose_exact && move == 1);
  // The way to the first pose is not known: it counts as none.
  const PoseError error = is_exact ? PoseError() : options_.error->of_move(moves_ > 0 ? believed_ : view, view);
  if (!error.is_zero()) {
    Random random = error_stream(seed_, move);
    int draws = 0;
    do {
      if (++draws > most_draws) return false;
      reached = perturbed(view, error, random);
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
  RangeImage image = noisy(scanner_.scan(camera_, true_), options_.sensor, random);
  if (options_.flying_pixels == FlyingPixelRule::keep) return image;
  return without_flying_pixels(std::move(image), options_.sensor).image;
}

}  // namespace vantage
