#include "vantage/planning/registrability.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

const SensorModel sensor{.constant = 0.002, .quadratic = 0.001};
const PoseError robot = PoseError::from_deviations(Vec3::Constant(0.05), Vec3::Constant(radians(2)));

VoxelMap empty_map() {
  SceneOptions scene;
  scene.voxel_length = 0.02;
  scene.scene_size = scene.enclosure_size = Index3::Constant(41);
  return VoxelMap(scene);
}

void put(VoxelMap& map, const Vec3& point, const Vec3& normal) {
  (void)map.add_point(map.grid().index_of(point), normal, 1);
}

/// A square sheet across z, seen from above.
VoxelMap sheet() {
  VoxelMap map = empty_map();
  for (double x = -0.3; x <= 0.3; x += 0.02) {
    for (double y = -0.3; y <= 0.3; y += 0.02) put(map, Vec3(x, y, 0), Vec3::UnitZ());
  }
  return map;
}

VoxelMap ball(double radius) {
  VoxelMap map = empty_map();
  Random random(3, 0);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 normal = random.normal3().normalized();
    put(map, radius * normal, normal);
  }
  return map;
}

const View above = view_towards(Vec3(0.1, 0.2, 2), Vec3::Zero());

std::vector<Index3> upper_half(const VoxelMap& map) {
  std::vector<Index3> seen;
  for (const Index3& voxel : map.occupied_voxels()) {
    if (map.surface(voxel)->normal().z() > 0.2) seen.push_back(voxel);
  }
  return seen;
}

TEST(Registrability, EffectOfAnErrorIsHowFarItMovesAMeasuredPointAlongTheNormal) {
  Random random(5, 0);
  for (int i = 0; i < 100; ++i) {
    const View view = view_towards(2 * random.normal3(), 0.1 * random.normal3());
    const Vec3 point = 0.3 * random.normal3();
    const Vec3 normal = random.normal3().normalized();
    PoseError::Vector error;
    error << 1e-6 * random.normal3(), 1e-6 * random.normal3();
    const Vec3 measured = view.world_from_sensor.inverse() * point;
    const double moved = normal.dot(displaced(view, error).world_from_sensor * measured - point);
    EXPECT_NEAR(effect_of_error(view, point, normal).dot(error), moved, 1e-10);
  }
}

TEST(Registrability, PosteriorIsTheInverseOfTheSumOfBothInformations) {
  Random random(6, 0);
  PoseError::Matrix a, b;
  for (int i = 0; i < 36; ++i) {
    a(i) = random.normal3().x();
    b(i) = random.normal3().x();
  }
  const PoseError::Matrix prior = a * a.transpose(), information = b * b.transpose();
  const PoseError::Matrix expected = (prior.inverse() + information).inverse();
  EXPECT_TRUE(posterior_covariance(prior, information).isApprox(expected, 1e-8));
  // What is certain stays certain.
  EXPECT_TRUE(posterior_covariance(PoseError::Matrix::Zero(), information).isZero(0));
}

TEST(Registrability, ProbabilityIsThatOfDrawnErrors) {
  Random random(7, 0);
  for (const double limit : {0.5, 1.0, 2.0, 5.0, 10.0}) {
    PoseError::Matrix weights = PoseError::Matrix::Zero();
    weights.diagonal() << 1, 0.5, 0.25, 0.1, 0.05, 0;
    int below = 0;
    constexpr int draws = 20000;
    for (int i = 0; i < draws; ++i) {
      PoseError::Vector e;
      e << random.normal3(), random.normal3();
      if (e.dot(weights * e) < limit) ++below;
    }
    EXPECT_NEAR(probability_below(weights, PoseError::Matrix::Identity(), limit), double{1} * below / draws, 0.04)
        << limit;
  }
}

TEST(Registrability, NothingInCommonLeavesTheRobotsError) {
  const VoxelMap map = ball(0.3);
  const KnownSurface surface(map, sensor);
  const Registrability nothing = surface.registrability(above, {}, robot);
  // 5 cm along the normal, and two degrees at about two metres: 5 to 10 cm.
  EXPECT_GT(nothing.misplacement, 0.05);
  EXPECT_LT(nothing.misplacement, 0.1);
  EXPECT_LT(nothing.probability, 0.1);
  const Registrability exact = surface.registrability(above, {}, PoseError());
  EXPECT_EQ(exact.misplacement, 0);
  EXPECT_EQ(exact.probability, 1);
}

TEST(Registrability, WhatSlidesInItselfMisplacesNoSurface) {
  // A ball leaves its three rotations open, a sheet two shifts and a turn: neither puts its surface off itself.
  for (const VoxelMap& map : {ball(0.3), sheet()}) {
    const Registrability half = KnownSurface(map, sensor).registrability(above, upper_half(map), robot);
    EXPECT_LT(half.misplacement, 0.005);
    EXPECT_GT(half.probability, 0.95);
  }
}

TEST(Registrability, FewPointsAreSeldomEnough) {
  // As observed, in points of 15 a voxel: below 3,000 hardly any scan, up to 6,000 less than half, then nearly all.
  EXPECT_EQ(chance_of_acceptance(0), 0.06);
  EXPECT_LT(chance_of_acceptance(2200), 0.1);
  EXPECT_GT(chance_of_acceptance(4500), 0.3);
  EXPECT_LT(chance_of_acceptance(4500), 0.7);
  EXPECT_GT(chance_of_acceptance(9000), 0.9);
}

TEST(Registrability, ASheetDoesNotSayWhereAWallBesideItIs) {
  VoxelMap map = sheet();
  const std::vector<Index3> seen = upper_half(map);
  for (double y = -0.3; y <= 0.3; y += 0.02) {
    for (double z = -0.3; z < -0.02; z += 0.02) put(map, Vec3(-0.3, y, z), -Vec3::UnitX());
  }
  const Registrability with_wall = KnownSurface(map, sensor).registrability(above, seen, robot);
  EXPECT_GT(with_wall.misplacement, 0.01) << "the sheet leaves shifts along x open, which move the wall";
  EXPECT_LT(with_wall.probability, 0.6);
}

TEST(Registrability, MoreOverlapIsMoreCertain) {
  const VoxelMap map = ball(0.3);
  const KnownSurface surface(map, sensor);
  const std::vector<Index3> seen = upper_half(map);
  double last = 1;
  for (const std::size_t count : {2U, 5U, 20U, 100U}) {
    const Registrability few = surface.registrability(above, std::span(seen).first(count), robot);
    EXPECT_LT(few.misplacement, last) << count;
    last = few.misplacement;
  }
}

TEST(Registrability, OptionsSayWhatIsWrong) {
  RegistrabilityOptions options;
  options.least_probability = 1.5;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vantage
