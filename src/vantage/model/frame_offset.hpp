#pragma once

#include <span>

#include "vantage/registration/pose_estimate.hpp"

namespace vantage {

/// A scan whose pose was believed, by what the robot says alone, and has been found by registration.
struct FoundPose {
  PoseEstimate believed;
  Pose found = Pose::Identity();  // in the frame of the model
};

/// The rigid motion from the robot's frame into that of the model, which the first scan defines: its own error is in
/// the place of every later scan. Each scan that was found tells something of it; what is left is part of what is
/// believed of the next one.
class FrameOffset {
 public:
  /// At least one scan, in the order in which they were found. Their errors are independent.
  explicit FrameOffset(std::span<const FoundPose> scans);

  /// Of a pose in the robot's frame, what is believed of it in the model's.
  [[nodiscard]] PoseEstimate in_model(const PoseEstimate& believed) const;

  /// Metres and radians about the first scan's sensor, in the order of pose_step().
  [[nodiscard]] const Vec6& mean() const { return mean_; }
  [[nodiscard]] const Mat6& covariance() const { return covariance_; }

 private:
  Vec3 pivot_;
  Vec6 mean_;
  Mat6 covariance_;
};

}  // namespace vantage
