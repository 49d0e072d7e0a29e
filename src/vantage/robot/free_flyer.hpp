#pragma once

#include "vantage/robot/reach.hpp"
#include "vantage/robot/robot_model.hpp"

namespace vantage {

/// A ball with the sensor in its middle that flies and turns as it likes, within its workspace. A move costs the metres
/// of its way through known free space.
class FreeFlyer : public RobotModel {
 public:
  /// Body radius and workspace; obstacles come with the surroundings. Throws InputError as ReachOptions::validate does.
  explicit FreeFlyer(const ReachOptions& reach);

  [[nodiscard]] std::unique_ptr<Mobility> among(const Surroundings& surroundings) const override;

 private:
  ReachOptions reach_;
};

}  // namespace vantage
