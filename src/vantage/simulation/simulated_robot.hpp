#pragma once

#include <cstdint>
#include <functional>

#include "vantage/core/random.hpp"
#include "vantage/robot/positioning_error.hpp"
#include "vantage/robot/robot.hpp"
#include "vantage/simulation/depth_noise.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {

/// Draws where a robot ends up: the commanded position plus N(mean, covariance), the commanded orientation.
class PositioningErrorModel {
 public:
  /// Throws InputError as PositioningError::validate does.
  explicit PositioningErrorModel(const PositioningError& error);

  [[nodiscard]] View perturb(const View& commanded, Random& random) const;

 private:
  Vec3 mean_;
  Mat3 root_;  // root * root^T = covariance
};

struct SimulatedRobotOptions {
  PositioningError error = {};    // of every move
  bool first_pose_exact = false;  // the first move ends where it was commanded (spec, section 6: with ICP)
  DepthNoise depth_noise = {};    // of every range image

  void validate() const;
};

/// A free flyer with a range camera in front of a mesh. It ends up at the commanded position plus a random error, keeps
/// the commanded orientation, and believes to be where it was sent (spec, section 6). The error and the noise of the
/// n-th move depend on the seed and n alone, so that runs with other plans meet the same errors.
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
  PositioningErrorModel error_;
  std::uint64_t seed_;
  std::function<bool(const View&)> can_be_at_;
  std::uint64_t moves_ = 0;
  View believed_, true_;
};

}  // namespace vantage
