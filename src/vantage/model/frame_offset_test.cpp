#include "vantage/model/frame_offset.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {
namespace {

constexpr double sigma_position = 0.01, sigma_angle = radians(1);

/// The pose that a robot reports whose true one is `truth`.
Pose reported(const Pose& truth, Random& random) {
  Vec6 error;
  error << sigma_position * random.normal3(), sigma_angle * random.normal3();
  return stepped(truth, error);
}

/// Views from around the origin whose robot errs. Registration finds all of them without an error, in the frame of the
/// first.
std::vector<FoundPose> found_poses(int count, Random& random, Pose& model_from_world) {
  std::vector<FoundPose> scans;
  for (int i = 0; i < count; ++i) {
    const Pose truth = view_towards(1.5 * random.unit_vector(), Vec3::Zero()).world_from_sensor;
    const Pose believed = reported(truth, random);
    if (i == 0) model_from_world = believed * truth.inverse();
    scans.push_back({PoseEstimate::around(believed, sigma_position, sigma_angle), model_from_world * truth});
  }
  return scans;
}

TEST(FrameOffset, TheErrorOfTheFirstScanIsInThePlaceOfTheNext) {
  const Pose first = view_towards({1.5, 0, 0}, Vec3::Zero()).world_from_sensor;
  const FrameOffset offset(std::vector<FoundPose>{{PoseEstimate::around(first, sigma_position, sigma_angle), first}});
  const Pose opposite = view_towards({-1.5, 0, 0}, Vec3::Zero()).world_from_sensor;
  const PoseEstimate next = offset.in_model(PoseEstimate::around(opposite, sigma_position, sigma_angle));
  EXPECT_TRUE(next.mean.isApprox(opposite));
  // Turned about the first sensor, the other one three metres away moves across, not along the line between both.
  EXPECT_NEAR(std::sqrt(next.covariance(0, 0)), std::sqrt(2) * sigma_position, 1e-6);
  EXPECT_NEAR(std::sqrt(next.covariance(1, 1)), std::hypot(std::sqrt(2) * sigma_position, 3 * sigma_angle), 1e-6);
  EXPECT_NEAR(std::sqrt(next.covariance(4, 4)), std::sqrt(2) * sigma_angle, 1e-6);
}

TEST(FrameOffset, AnExactFirstScanLeavesNothingOpen) {
  const Pose first = view_towards({1.5, 0, 0}, Vec3::Zero()).world_from_sensor;
  const Pose second = view_towards({0, 1.5, 0}, Vec3::Zero()).world_from_sensor;
  const FrameOffset offset(std::vector<FoundPose>{
      {{first, Mat6::Zero()}, first},
      {PoseEstimate::around(second, sigma_position, sigma_angle), stepped(second, Vec6::Constant(0.01))}});
  const PoseEstimate believed = PoseEstimate::around(second, sigma_position, sigma_angle);
  EXPECT_EQ(offset.in_model(believed).mean.matrix(), second.matrix());
  EXPECT_EQ(offset.in_model(believed).covariance, believed.covariance);
}

TEST(FrameOffset, MoreScansTellWhereTheFirstOneReallyWas) {
  Random random(5);
  double one = 0, nine = 0, chi_squared = 0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    Pose model_from_world;
    const std::vector<FoundPose> scans = found_poses(9, random, model_from_world);
    const Pose truth = view_towards(1.5 * random.unit_vector(), Vec3::Zero()).world_from_sensor;
    const auto step = [&](std::span<const FoundPose> known) {
      const PoseEstimate expected = FrameOffset(known).in_model({truth, Mat6::Zero()});
      const Vec6 off = pose_step(expected.mean, model_from_world * truth);
      if (known.size() == scans.size()) chi_squared += off.dot(inverse_covariance(expected.covariance) * off) / trials;
      return off.head<3>().norm() / trials;
    };
    one += step(std::span(scans).first(1));
    nine += step(scans);
  }
  EXPECT_LT(nine, 0.5 * one);
  EXPECT_NEAR(chi_squared, 6, 1);  // as large as is said
}

TEST(FrameOffset, NeedsAScan) { EXPECT_THROW(FrameOffset({}), InputError); }

}  // namespace
}  // namespace vantage
