#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "vantage/core/random.hpp"
#include "vantage/model/sensor_options.hpp"
#include "vantage/robot/error_model.hpp"
#include "vantage/robot/robot.hpp"
#include "vantage/simulation/depth_noise.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {

/// Draws where a robot ends up that is sent to `commanded`. The position takes the first three random numbers, so that
/// it is the same with and without an error of the orientation. Throws InputError as PoseError::validate does.
[[nodiscard]] View perturbed(const View& commanded, const PoseError& error, Random& random);

struct SimulatedRobotOptions {
  std::shared_ptr<const PoseErrorModel> error = {};  // of each move; none: the robot is exact
  bool first_pose_exact = false;  // the first move ends where it was commanded (spec, section 6: with ICP)
  SensorModel sensor = {};        // errors of every range image
  FlyingPixelRule flying_pixels = FlyingPixelRule::keep;

  void validate() const;
};

/// A robot with a range camera in front of a mesh. It ends up at the commanded pose plus a random error and believes to
/// be where it was sent (spec, section 6). The error and the noise of the n-th move depend on the seed and n alone, so
/// that runs with other plans meet the same errors.
class SimulatedRobot : public Robot {
 public:
  /// The scanner must outlive the robot. `can_be_at` tells where there is room: commands to other places fail, errors
  /// that lead elsewhere are drawn again. Throws InputError where the camera or an option is invalid.
  SimulatedRobot(
      const RangeScanner& scanner, const RangeCamera& camera, const SimulatedRobotOptions& options, std::uint64_t seed,
      std::function<bool(const View&)> can_be_at = [](const View&) { return true; });

  [[nodiscard]] bool move_to(const View& view) override;
  [[nodiscard]] RangeImage take_range_image() override;
  [[nodiscard]] View view() const override { return believed_; }
  /// Where the sensor really is.
  [[nodiscard]] View true_view() const { return true_; }

 private:
  const RangeScanner& scanner_;
  RangeCamera camera_;
  SimulatedRobotOptions options_;
  std::uint64_t seed_;
  std::function<bool(const View&)> can_be_at_;
  std::uint64_t moves_ = 0;
  View believed_, true_;
};

}  // namespace vantage
