#pragma once

#include <functional>

#include "vantage/core/random.hpp"
#include "vantage/robot/positioning_error.hpp"
#include "vantage/robot/robot.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {

struct SimulatedRobotOptions {
  PositioningError error;         // of every move
  bool first_pose_exact = false;  // the first move ends where it was commanded (spec, section 6: with ICP)

  void validate() const;
};

/// A free flyer with a range camera in front of a mesh. It ends up at the commanded position plus a random error, keeps
/// the commanded orientation, and believes to be where it was sent (spec, section 6).
class SimulatedRobot : public Robot {
 public:
  /// The scanner must outlive the robot. `can_be_at` tells where there is room; errors that lead elsewhere are redrawn.
  SimulatedRobot(
      const RangeScanner& scanner, const RangeCamera& camera, const SimulatedRobotOptions& options, std::uint64_t seed,
      std::function<bool(const View&)> can_be_at = [](const View&) { return true; });

  [[nodiscard]] bool move_to(const View& view) override;
  [[nodiscard]] RangeImage take_range_image() override;
  [[nodiscard]] View view() const override { return believed_; }
  /// Where the sensor really is.
  [[nodiscard]] View true_view() const { return true_; }

 private:
  [[nodiscard]] View erroneous(const View& commanded);

  const RangeScanner& scanner_;
  RangeCamera camera_;
  SimulatedRobotOptions options_;
  Mat3 root_;  // of the covariance
  Random error_random_;
  std::function<bool(const View&)> can_be_at_;
  int moves_ = 0;
  View believed_, true_;
};

}  // namespace vantage
