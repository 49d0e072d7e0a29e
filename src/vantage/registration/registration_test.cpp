#include "vantage/registration/registration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "support/analytic_scan.hpp"
#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/registration/pose_fit.hpp"
#include "vantage/sensor/scan_cloud.hpp"

namespace vantage {
namespace {

using test::Solid;
using testing::HasSubstr;

RangeCamera small_camera() { return camera_from_apertures(radians(34), radians(34), {128, 128}); }

constexpr SensorModel exact;

ScanSurface scan(const Solid& solid, const View& view) {
  return scan_surface(test::scan_solid(solid, small_camera(), view), exact);
}

/// A believed pose: the true one with its position off by a vector and its orientation turned.
Pose disturbed(const Pose& truth, const Vec3& shift, double angle, const Vec3& axis) {
  Pose pose = truth;
  pose.translation() += shift;
  pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * pose.linear();
  return pose;
}

RegisteredSurface model_of(const Solid& solid, const View& view) {
  RegisteredSurface model;
  model.merge(scan(solid, view), view.world_from_sensor);
  return model;
}

/// With the errors of these tests: 5 cm and 2 degrees.
Registration registered(const RegisteredSurface& model, const ScanSurface& scan, const Pose& believed) {
  return register_scan(model, scan, PoseEstimate::around(believed, 0.05, radians(2)));
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
    const RegisteredSurface model = model_of(solid, view_towards(2 * from, Vec3::Zero()));
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

TEST(Registration, FreeSpaceSaysWhereABarEnds) {
  // A long bar slid along itself fits; only the empty space beyond its end speaks against it.
  const Solid bar = test::box(Vec3::Zero(), Vec3(0.9, 0.15, 0.15));
  const View view = view_towards({0, -1.6, 1.2}, Vec3::Zero());
  const RegisteredSurface model = model_of(bar, view);
  const ScanSurface again = scan(bar, view);
  // The robot is known to err by a millimetre: the pose stays, and is refused.
  const Pose slid = disturbed(view.world_from_sensor, {0.1, 0, 0}, 0, Vec3::UnitX());
  const Registration found = register_scan(model, again, PoseEstimate::around(slid, 0.001, radians(0.01)));
  EXPECT_FALSE(found.succeeded()) << found.explanation;
}

TEST(Registration, GivesTheSameBitsForAnyNumberOfThreads) {
  const Solid solid = test::knobbly(0.8);
  const RegisteredSurface model = model_of(solid, view_towards({2, 0, 1}, Vec3::Zero()));
  const View view = view_towards({1.6, 1, 1}, Vec3::Zero());
  const ScanSurface next = scan(solid, view);
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
    EXPECT_EQ(result.covariance, results[0].covariance);
    EXPECT_EQ(result.explanation, results[0].explanation);
  }
}

/// Squared distance of the true pose from what was found, in its standard deviations.
double chi_squared(const Registration& found, const View& truth) {
  const WhitenedPrior posterior(found.estimate());
  const Eigen::MatrixXd root = posterior.root();
  const Vec6 step = pose_step(found.world_from_sensor, truth.world_from_sensor);
  return (root.completeOrthogonalDecomposition().pseudoInverse() * step).squaredNorm();
}

TEST(Registration, PlaneMovesOnlyAlongItsNormalAndTilts) {
  const Solid solid = test::ground(0);
  const View first = view_towards({0, 0.5, 2}, Vec3::Zero());
  const View second = view_towards({0.4, 0.2, 2}, Vec3::Zero());
  const Pose believed = disturbed(second.world_from_sensor, {0.03, -0.02, 0.04}, radians(2), Vec3::UnitX());
  const Registration found = registered(model_of(solid, first), scan(solid, second), believed);
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_EQ(found.undetermined_directions, 3);
  EXPECT_THAT(found.explanation, HasSubstr("3 directions are not determined by the shape and stay as believed"));
  // What the plane fixes is right ...
  const Pose error = found.world_from_sensor * second.world_from_sensor.inverse();
  EXPECT_NEAR((error * Vec3::Zero()).z(), 0, 1e-4);
  EXPECT_NEAR((error.linear() * Vec3::UnitZ()).z(), 1, 1e-7);
  // ... and what it leaves open is known to be as uncertain as it was.
  EXPECT_LT(chi_squared(found, second), chi_squared_limit(6));
  EXPECT_NEAR(std::sqrt(found.covariance(0, 0)), 0.05, 0.01);
  EXPECT_NEAR(std::sqrt(found.covariance(5, 5)), radians(2), radians(0.2));
  EXPECT_LT(found.misplacement, 0.001);
}

TEST(Registration, SphereKeepsWhatIsBelievedOfItsOrientation) {
  const Solid solid = test::sphere(Vec3::Zero(), 0.4);
  const View first = view_towards({2, 0, 0}, Vec3::Zero());
  const View second = view_towards({1.7, 1, 0}, Vec3::Zero());
  const Pose believed = disturbed(second.world_from_sensor, {0.03, -0.05, 0.04}, 0, Vec3::UnitX());
  const Registration found = registered(model_of(solid, first), scan(solid, second), believed);
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_EQ(found.undetermined_directions, 3);
  // The sphere is where it is; where on the circle around it the sensor is, is not known.
  const Pose error = found.world_from_sensor * second.world_from_sensor.inverse();
  EXPECT_LT((error * Vec3::Zero()).norm(), 1e-3);
  EXPECT_LT(chi_squared(found, second), chi_squared_limit(6));
  EXPECT_LT(found.misplacement, 0.001);
}

TEST(Registration, ARobotThatKeepsItsOrientationKeepsItOnASphere) {
  const Solid solid = test::sphere(Vec3::Zero(), 0.4);
  const View second = view_towards({1.7, 1, 0}, Vec3::Zero());
  const Pose believed = disturbed(second.world_from_sensor, {0.03, -0.05, 0.04}, 0, Vec3::UnitX());
  const Registration found = register_scan(model_of(solid, view_towards({2, 0, 0}, Vec3::Zero())), scan(solid, second),
                                           PoseEstimate::around(believed, 0.05, 0));
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_EQ(found.undetermined_directions, 0);
  EXPECT_EQ(found.world_from_sensor.linear(), believed.linear());
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
  const Pose error = found.world_from_sensor * second.world_from_sensor.inverse();
  for (const double z : {-0.3, 0.3}) EXPECT_LT((error * Vec3(0, 0, z)).head<2>().norm(), 1e-3);
  EXPECT_LT(chi_squared(found, second), chi_squared_limit(6));
}

TEST(Registration, TwoScansFindEachOther) {
  const Solid solid = test::knobbly(0.8);
  const View one = view_towards({2, 0, 1}, Vec3::Zero()), other = view_towards({1.6, 1, 1}, Vec3::Zero());
  const Pose truth = one.world_from_sensor.inverse() * other.world_from_sensor;
  const Pose believed = disturbed(truth, {0.04, -0.03, 0.05}, radians(2), Vec3::UnitX());
  const Registration found =
      register_pair(scan(solid, one), scan(solid, other), PoseEstimate::around(believed, 0.05, radians(2)));
  ASSERT_TRUE(found.succeeded()) << found.explanation;
  EXPECT_LT((found.world_from_sensor.translation() - truth.translation()).norm(), 0.005);
  EXPECT_LT(rotation_angle(found.world_from_sensor.linear(), truth.linear()), radians(0.2));
}

TEST(Registration, NothingIsMergedBeyondThePrior) {
  const Solid solid = test::knobbly(0.8);
  const View view = view_towards({1.6, 1, 1}, Vec3::Zero());
  const RegisteredSurface model = model_of(solid, view_towards({2, 0, 1}, Vec3::Zero()));
  const Pose believed = disturbed(view.world_from_sensor, {0.03, 0, 0}, 0, Vec3::UnitX());
  const Registration found = register_scan(model, scan(solid, view), PoseEstimate::around(believed, 0.003, 0.001));
  EXPECT_FALSE(found.succeeded()) << found.explanation;
}

TEST(Registration, RefusesAScanWithoutOverlap) {
  const Solid solid = test::l_shape(0.8);
  const RegisteredSurface model = model_of(solid, view_towards({0, 0, 2}, Vec3::Zero()));
  const View below = view_towards({0.1, 0.1, -2}, Vec3::Zero());
  const Registration found = registered(model, scan(solid, below), below.world_from_sensor);
  EXPECT_EQ(found.verdict, Verdict::insufficient_overlap);
  EXPECT_THAT(found.explanation, HasSubstr("of the scan lies on the model"));
}

TEST(Registration, TellsOfEmptyScans) {
  const RegisteredSurface model = model_of(test::l_shape(0.8), view_towards({0, 0, 2}, Vec3::Zero()));
  const Pose believed = look_at({0, 1, 2}, Vec3::Zero());
  const Registration found = registered(model, ScanSurface{}, believed);
  EXPECT_EQ(found.verdict, Verdict::insufficient_overlap);
  EXPECT_EQ(found.world_from_sensor.matrix(), believed.matrix());
  EXPECT_THAT(found.explanation, HasSubstr("the scan has 0 samples"));
}

TEST(Registration, OptionsNameTheFieldAndTheValue) {
  try {
    RegistrationOptions options;
    options.outlier_share = 1.5;
    (void)register_scan({}, {}, {}, options);
    FAIL() << "accepted outlier_share = 1.5";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "outlier_share = 1.5: must be in [0, 1)");
  }
}

TEST(Registration, EveryVerdictHasAName) {
  EXPECT_EQ(name(Verdict::registered), "registered");
  EXPECT_EQ(name(Verdict::insufficient_overlap), "insufficient overlap");
  EXPECT_EQ(name(Verdict::not_converged), "not converged");
}

}  // namespace
}  // namespace vantage
