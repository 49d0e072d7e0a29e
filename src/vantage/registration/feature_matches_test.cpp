#include "vantage/registration/feature_matches.hpp"

#include <gtest/gtest.h>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

/// A bumpy surface over a square, with normals, from outside.
std::vector<SurfaceSample> bumpy() {
  const auto height = [](double x, double y) {
    return 0.06 * std::sin(9 * x + 1) * std::cos(7 * y) + 0.04 * std::sin(17 * x * y + 4 * y) + 0.1 * x * x * y;
  };
  std::vector<SurfaceSample> samples;
  constexpr double step = 0.01, small = 1e-5;
  for (double x = 0; x < 0.8; x += step) {
    for (double y = 0; y < 0.8; y += step) {
      const double dx = (height(x + small, y) - height(x - small, y)) / (2 * small);
      const double dy = (height(x, y + small) - height(x, y - small)) / (2 * small);
      samples.push_back({Vec3(x, y, height(x, y)), Vec3(-dx, -dy, 1).normalized(), 0.001});
    }
  }
  return samples;
}

TEST(FeatureMatches, FindHowASurfaceWasMoved) {
  const std::vector<SurfaceSample> fixed = bumpy();
  Pose fixed_from_moving = Pose::Identity();
  fixed_from_moving.linear() = Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  fixed_from_moving.translation() = Vec3(0.4, -1.3, 0.7);
  const Pose back = fixed_from_moving.inverse();
  std::vector<SurfaceSample> moving;
  for (const SurfaceSample& sample : fixed) {
    if (sample.point.x() > 0.2)  // only a part of it was seen
      moving.push_back({back * sample.point, back.linear() * sample.normal, sample.sigma});
  }
  const SurfaceFeatures of_fixed = surface_features(fixed, 0.015), of_moving = surface_features(moving, 0.015);
  const std::vector<FeatureMatch> matches = feature_matches(of_fixed, of_moving);
  ASSERT_FALSE(matches.empty());
  const std::vector<PoseHypothesis> found = pose_hypotheses(of_fixed, of_moving, matches);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(rotation_angle(found[0].fixed_from_moving.linear(), fixed_from_moving.linear()), radians(3));
  EXPECT_LT((found[0].fixed_from_moving * moving[0].point - fixed[0].point).norm(), 0.3);
}

TEST(FeatureMatches, DescriptorsDoNotDependOnThePose) {
  const std::vector<SurfaceSample> samples = bumpy();
  // A whole number of cells, so that the same samples are averaged.
  std::vector<SurfaceSample> moved = samples;
  for (SurfaceSample& sample : moved) sample.point += Vec3(0.25, -0.5, 0.125);
  const SurfaceFeatures a = surface_features(samples, 0.0625), b = surface_features(moved, 0.0625);
  ASSERT_EQ(a.places.size(), b.places.size());
  for (std::size_t i = 0; i < a.places.size(); ++i) EXPECT_GT(a.descriptors[i].dot(b.descriptors[i]), 0.999F);
}

TEST(FeatureMatches, ConsistencyIsThatOfDistancesAndNormals) {
  SurfaceFeatures fixed{.cell = 0.01, .places = {}, .descriptors = {}};
  fixed.places = {{Vec3::Zero(), Vec3::UnitZ(), 0}, {Vec3(0.1, 0, 0), Vec3::UnitZ(), 0}};
  SurfaceFeatures moving = fixed;
  const FeatureMatch a{0, 0, 1}, b{1, 1, 1};
  EXPECT_TRUE(are_consistent(fixed, moving, a, b));
  EXPECT_FALSE(are_consistent(fixed, moving, a, a));
  moving.places[1].point.x() = 0.12;  // two cells farther
  EXPECT_FALSE(are_consistent(fixed, moving, a, b));
  moving = fixed;
  moving.places[1].normal = Vec3::UnitY();
  EXPECT_FALSE(are_consistent(fixed, moving, a, b));
}

}  // namespace
}  // namespace vantage
