#include "vantage/registration/registration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "support/analytic_scan.hpp"
#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/sensor/scan_cloud.hpp"

namespace vantage {
namespace {

using test::Solid;
using testing::HasSubstr;

RangeCamera small_camera() { return camera_from_apertures(radians(34), radians(34), {128, 128}); }

struct Scan {
  RangeImage image;
  PointCloud cloud;
};

Scan scan(const Solid& solid, const View& view) {
  RangeImage image = test::scan_solid(solid, small_camera(), view);
  PointCloud cloud = scan_cloud(image, range_image_normals(image));
  return {std::move(image), std::move(cloud)};
}

/// A believed pose: the true one with its position off by a vector and its orientation turned.
Pose disturbed(const Pose& truth, const Vec3& shift, double angle, const Vec3& axis) {
  Pose pose = truth;
  pose.translation() += shift;
  pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * pose.linear();
  return pose;
}

constexpr double spacing = 0.0095;  // of such a scan from 2 m

ModelSurface model_of(const Solid& solid, const View& view) {
  ModelSurface model(spacing);
  Scan first = scan(solid, view);
  model.merge(first.cloud, std::move(first.image), view.world_from_sensor);
  return model;
}

Registration registered(const ModelSurface& model, const Scan& scan, const Pose& believed) {
  RegistrationOptions options;
  options.orientation_error = radians(2);  // the largest standard deviation of the tests
  return register_scan(model, scan.cloud, scan.image, believed, options);
}

/// How far a registration's pose is off, at the object's centre (the world's origin) and as an angle.
struct PoseError {
  double shift = 0;  // m
  double angle = 0;  // rad
};

PoseError pose_error(const Registration& found, const View& truth) {
  const Pose error = found.world_from_sensor * truth.world_from_sensor.inverse();
  return {error.translation().norm(), rotation_angle(error.linear(), Mat3::Identity())};
}

/// Registers scans of the solid from random places, 35 degrees away from the model's only scan, with random errors of
/// the believed pose. Returns the errors of the poses that were accepted.
std::vector<PoseError> accepted_errors(const Solid& solid, int trials) {
  Random random(1);
  std::vector<PoseError> accepted;
  for (int trial = 0; trial < trials; ++trial) {
    const Vec3 from = random.unit_vector();
    const ModelSurface model = model_of(solid, view_towards(2 * from, Vec3::Zero()));
    const View view = view_towards(2 * (Eigen::AngleAxisd(radians(35), from.unitOrthogonal()) * from), Vec3::Zero());
    const Pose believed =
        disturbed(view.world_from_sensor, 0.05 * random.normal3(), radians(2) * random.normal(), random.unit_vector());
    const Registration found = registered(model, scan(solid, view), believed);
    if (found.succeeded()) accepted.push_back(pose_error(found, view));
  }
  return accepted;
}

TEST(Registration, RecoversRandomDisturbances) {
  const std::vector<PoseError> accepted = accepted_errors(test::knobbly(0.8), 30);
  EXPECT_GE(accepted.size(), 25U);
  for (const PoseError& error : accepted) {
    EXPECT_LT(error.shift, 0.005);
    EXPECT_LT(error.angle, radians(0.5));
  }
}

TEST(Registration, RefusesWhatFewFacesLeaveOpen) {
  // Two views of an L share one to three faces, mostly too few to fix a pose: then nothing but refusing is right.
  const std::vector<PoseError> accepted = accepted_errors(test::l_shape(0.8), 30);
  EXPECT_GE(accepted.size(), 3U);
  EXPECT_LE(accepted.size(), 15U);
  for (const PoseError& error : accepted) {
    EXPECT_LT(error.shift, 0.02);
    EXPECT_LT(error.angle, radians(0.5));
  }
}

TEST(ModelSurface, KeepsEverySecondImageOnceThereAreMany) {
  ModelSurface model(0.1);
  const RangeImage image{camera_from_apertures(radians(45), radians(45), {2, 2}), std::vector<float>(4)};
  const auto firsts = [&] {
    std::vector<double> all;
    for (const PosedImage& each : model.images()) all.push_back(each.world_from_sensor.translation().x());
    return all;
  };
  for (int i = 0; i < 64; ++i) model.merge({}, image, Pose(Eigen::Translation3d(i, 0, 0)));
  EXPECT_EQ(firsts().size(), 64U);
  for (int i = 64; i < 1000; ++i) model.merge({}, image, Pose(Eigen::Translation3d(i, 0, 0)));
  ASSERT_EQ(firsts().size(), 63U) << "of 0 to 999 every 16th";
  for (std::size_t i = 0; i < 63; ++i) EXPECT_EQ(firsts()[i], static_cast<double>(16 * i));
}

TEST(Registration, RefusesAPoseThatFitsButStandsInFreeSpace) {
  // A long bar slid along itself fits; only the empty space beyond its end speaks against it.
  const Solid bar = test::box(Vec3::Zero(), Vec3(0.9, 0.15, 0.15));
  const View view = view_towards({0, -1.6, 1.2}, Vec3::Zero());
  const ModelSurface model = model_of(bar, view);
  const Scan again = scan(bar, view);
  const Pose slid = disturbed(view.world_from_sensor, {0.1, 0, 0}, 0, Vec3::UnitX());
  const FreeSpace seen(again.image, 0.02);
  EXPECT_EQ(seen.share_inside(model.cloud().points, view.world_from_sensor), 0);
  EXPECT_NEAR(seen.share_inside(model.cloud().points, slid), (0.1 - 0.02) / 0.9, 0.02);
  const Registration found = register_scan(model, again.cloud, again.image, slid);
  EXPECT_EQ(found.verdict, Verdict::in_free_space) << found.explanation;
}

TEST(Registration, GivesTheSameBitsForAnyNumberOfThreads) {
  const Solid solid = test::knobbly(0.8);
  const ModelSurface model = model_of(solid, view_towards({2, 0, 1}, Vec3::Zero()));
  const View view = view_towards({1.6, 1, 1}, Vec3::Zero());
  const Scan next = scan(solid, view);
  const Pose believed = disturbed(view.world_from_sensor, {0.04, -0.03, 0.05}, radians(2), Vec3::UnitX());
  std::vector<Registration> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(registered(model, next, believed));
  }
  ASSERT_TRUE(results[0].succeeded()) << results[0].explanation;
  for (const Registration& result : results) {
    EXPECT_EQ(result.world_from_sensor.matrix(), results[0].world_from_sensor.matrix());
    EXPECT_EQ(result.overlap, results[0].overlap);
    EXPECT_EQ(result.residual, results[0].residual);
    EXPECT_EQ(result.explanation, results[0].explanation);
  }
}

TEST(Registration, PlaneMovesOnlyAlongItsNormalAndTilts) {
  const Solid solid = test::ground(0);
  const View first = view_towards({0, 0.5, 2}, Vec3::Zero());
  const View second = view_towards({0.4, 0.2, 2}, Vec3::Zero());
  const Pose believed = disturbed(second.world_from_sensor, {0.03, -0.02, 0.04}, radians(2), Vec3::UnitX());
  const Registration found = registered(model_of(solid, first), scan(solid, second), believed);
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_EQ(found.undetermined_directions, 3);
  // What the plane fixes is right ...
  const Pose error = found.world_from_sensor * second.world_from_sensor.inverse();
  EXPECT_NEAR((error * Vec3::Zero()).z(), 0, 1e-4);
  EXPECT_NEAR((error.linear() * Vec3::UnitZ()).z(), 1, 1e-7);
  // ... and what it leaves open stays as believed: the scan's middle moves only in z and does not turn about z.
  const Pose motion = found.world_from_sensor * believed.inverse();
  const Vec3 middle = believed * Vec3(0, 0, 2.04);
  const Vec3 moved = motion * middle - middle;
  EXPECT_LT(moved.head<2>().norm(), 2e-3);
  const Eigen::AngleAxisd turn(Mat3(motion.linear()));
  EXPECT_LT(std::abs(turn.angle() * turn.axis().z()), radians(0.05));
}

TEST(Registration, SphereKeepsItsBelievedOrientation) {
  const Solid solid = test::sphere(Vec3::Zero(), 0.4);
  const View first = view_towards({2, 0, 0}, Vec3::Zero());
  const View second = view_towards({1.7, 1, 0}, Vec3::Zero());
  const Pose believed = disturbed(second.world_from_sensor, {0.03, -0.05, 0.04}, 0, Vec3::UnitX());
  const Registration found = registered(model_of(solid, first), scan(solid, second), believed);
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_EQ(found.undetermined_directions, 3);
  EXPECT_LT(rotation_angle(found.world_from_sensor.linear(), believed.linear()), radians(0.02));
  EXPECT_LT(pose_error(found, second).shift, 1e-3);
}

TEST(Registration, CylinderStaysAlongAndAboutItsAxis) {
  const Solid solid = test::cylinder(0.3, 10);
  const View first = view_towards({2, 0, 0}, Vec3::Zero());
  const View second = view_towards({1.7, 1, 0.1}, Vec3(0, 0, 0.1));
  const Pose believed = disturbed(second.world_from_sensor, {0.03, -0.04, 0.05}, 0, Vec3::UnitX());
  const Registration found = registered(model_of(solid, first), scan(solid, second), believed);
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_EQ(found.undetermined_directions, 2);
  EXPECT_NEAR(found.world_from_sensor.translation().z(), believed.translation().z(), 2e-3);
  EXPECT_LT((found.world_from_sensor.translation() - second.position()).head<2>().norm(), 5e-3);
}

TEST(Registration, RefusesAScanWithoutOverlap) {
  const Solid solid = test::l_shape(0.8);
  const ModelSurface model = model_of(solid, view_towards({0, 0, 2}, Vec3::Zero()));
  const View below = view_towards({0.1, 0.1, -2}, Vec3::Zero());
  const Registration found = registered(model, scan(solid, below), below.world_from_sensor);
  EXPECT_EQ(found.verdict, Verdict::insufficient_overlap);
  EXPECT_THAT(found.explanation, HasSubstr("of the scan lies on the model"));
}

TEST(Registration, TellsOfEmptyScans) {
  const ModelSurface model = model_of(test::l_shape(0.8), view_towards({0, 0, 2}, Vec3::Zero()));
  const Pose believed = look_at({0, 1, 2}, Vec3::Zero());
  const Registration found = register_scan(model, PointCloud{}, believed);
  EXPECT_EQ(found.verdict, Verdict::insufficient_overlap);
  EXPECT_EQ(found.world_from_sensor.matrix(), believed.matrix());
  EXPECT_THAT(found.explanation, HasSubstr("the scan has 0 points"));
}

TEST(Registration, OptionsNameTheFieldAndTheValue) {
  const ModelSurface model(0.01);
  try {
    RegistrationOptions options;
    options.least_overlap = 1.5;
    (void)register_scan(model, {}, Pose::Identity(), options);
    FAIL() << "accepted least_overlap = 1.5";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "least_overlap = 1.5: must be in (0, 1]");
  }
}

TEST(Registration, EveryVerdictHasAName) {
  EXPECT_EQ(name(Verdict::registered), "registered");
  EXPECT_EQ(name(Verdict::insufficient_overlap), "insufficient overlap");
  EXPECT_EQ(name(Verdict::not_converged), "not converged");
}

}  // namespace
}  // namespace vantage
