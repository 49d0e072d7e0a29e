#include "vantage/model/frame_offset.hpp"

#include "vantage/core/error.hpp"

namespace vantage {

FrameOffset::FrameOffset(std::span<const FoundPose> scans) {
  require(!scans.empty(), "frame offset: has no scan");
  pivot_ = scans.front().found.translation();
  mean_.setZero();
  covariance_.setZero();
  if (scans.front().believed.covariance.isZero(0)) return;  // it is where it is believed to be: the frames are one
  Mat6 information = Mat6::Zero();
  Vec6 side = Vec6::Zero();
  for (const FoundPose& scan : scans) {
    const Mat6 effect = effect_at(scan.believed.mean.translation() - pivot_);
    const Mat6 weighted = effect.transpose() * inverse_covariance(scan.believed.covariance);
    information += weighted * effect;
    side += weighted * pose_step(scan.believed.mean, scan.found);
  }
  covariance_ = inverse_covariance(information);  // both ways: metres and radians apart
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  mean_ = covariance_ * side;
}

PoseEstimate FrameOffset::in_model(const PoseEstimate& believed) const {
  const Mat6 effect = effect_at(believed.mean.translation() - pivot_);
  const Mat6 covariance = believed.covariance + effect * covariance_ * effect.transpose();
  return {stepped(believed.mean, effect * mean_), 0.5 * (covariance + covariance.transpose())};
}

}  // namespace vantage
