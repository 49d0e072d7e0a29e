#include "vantage/registration/scan_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

constexpr double spacing = 0.01;
constexpr double sigma = 0.001;

/// A piece of an ellipsoid's surface around a point of the sphere, seen from outside, in the frame of a sensor.
ScanSurface patch(const Vec3& towards, const Vec3& radii, const Pose& world_from_sensor, Random& random) {
  ScanSurface scan;
  scan.spacing = spacing;
  scan.sigma = sigma;
  const Pose sensor_from_world = world_from_sensor.inverse();
  while (scan.samples.size() < 3000) {
    const Vec3 on_sphere = random.normal3().normalized();
    if (on_sphere.dot(towards) < 0.2) continue;
    const Vec3 normal = on_sphere.cwiseQuotient(radii).normalized();
    const Vec3 point = on_sphere.cwiseProduct(radii) + sigma * random.normal3().x() * normal;
    scan.samples.push_back({sensor_from_world * point, sensor_from_world.linear() * normal, sigma});
  }
  return scan;
}

struct TwoScans {
  Pose first, second;
  PairedSurface on_first, on_second;

  TwoScans(const Vec3& radii, std::uint64_t seed) : TwoScans(radii, Random(seed, 0)) {}

 private:
  TwoScans(const Vec3& radii, Random random)
      : first(look_at(Vec3(1, 0.2, 0.3), Vec3::Zero())),
        second(look_at(Vec3(0.7, 0.8, 0.2), Vec3::Zero())),
        on_first(patch(first.translation().normalized(), radii, first, random)),
        on_second(patch(second.translation().normalized(), radii, second, random)) {}
};

const Vec3 ellipsoid(0.3, 0.2, 0.12);

Pose disturbed(const Pose& pose, double position, double angle) {
  Vec6 step;
  step << position * Vec3(1, -1, 0.5).normalized(), angle * Vec3(0.3, 1, -0.5).normalized();
  return stepped(pose, step);
}

TEST(ScanPairs, FindHowTwoScansLieToEachOther) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const TwoScans scans(ellipsoid, seed);
    const Pose truth = scans.first.inverse() * scans.second;
    const auto found = constraint_between(scans.on_first, scans.on_second, disturbed(truth, 0.008, 0.006));
    ASSERT_TRUE(found);
    EXPECT_LT(scans.on_second.mean_displacement(found->from_of_to, truth), sigma) << seed;
    EXPECT_TRUE((found->information - found->information.transpose()).isZero(1e-6 * found->information.norm()));
  }
}

TEST(ScanPairs, ErrorsAreThoseThatTheInformationPromises) {
  // Twenty draws of the noise: chi squared with six degrees of freedom, or less where errors in common are allowed for.
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TwoScans scans(ellipsoid, seed);
    const Pose truth = scans.first.inverse() * scans.second;
    const auto found = constraint_between(scans.on_first, scans.on_second, truth);
    ASSERT_TRUE(found);
    const Vec6 error = pose_step(found->from_of_to, truth);
    const double distance = error.dot(found->information * error);
    EXPECT_LT(distance, 16.81) << seed;
    sum += distance;
  }
  EXPECT_LT(sum / 20, 6);
}

TEST(ScanPairs, ABallLeavesItsRotationsOpen) {
  const Vec3 ball = Vec3::Constant(0.2);
  const TwoScans scans(ball, 5);
  const Pose truth = scans.first.inverse() * scans.second;
  const auto found = constraint_between(scans.on_first, scans.on_second, truth);
  ASSERT_TRUE(found);
  // A turn about the ball's center moves the sensor too: in the frame of the first sensor.
  const Vec3 center = scans.first.inverse() * Vec3::Zero();
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    Vec6 turn;
    turn << axis.cross(truth.translation() - center), axis;
    Vec6 shift;
    shift << axis, Vec3::Zero();
    const double held_turn = std::sqrt(turn.dot(found->information * turn)) / ball.x();  // per metre of surface
    const double held_shift = std::sqrt(shift.dot(found->information * shift));
    EXPECT_LT(held_turn, 0.2 * held_shift);
  }
}

TEST(ScanPairs, NothingComesOfScansThatShareTooLittle) {
  const TwoScans scans(ellipsoid, 4);
  const Pose apart = disturbed(scans.first.inverse() * scans.second, 0.5, 0);
  EXPECT_FALSE(constraint_between(scans.on_first, scans.on_second, apart));
  EXPECT_LT(scans.on_second.overlap(scans.on_first, apart), 0.1);
  EXPECT_GT(scans.on_second.overlap(scans.on_first, scans.first.inverse() * scans.second), 0.4);
  const PairedSurface nothing{ScanSurface()};
  EXPECT_FALSE(constraint_between(scans.on_first, nothing, Pose::Identity()));
  EXPECT_FALSE(constraint_between(nothing, scans.on_first, Pose::Identity()));
  ScanPairOptions options;
  options.shared_error = 0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vantage
