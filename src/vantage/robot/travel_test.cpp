#include "vantage/robot/travel.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(Travel, FollowsTheSphere) {
  const Travel travel{Travel::Path::orthodromic, Vec3(1, 1, 1), 2};
  const Vec3 from = Vec3(1, 1, 1) + Vec3(2, 0, 0);
  EXPECT_NEAR(travel.distance(from, Vec3(1, 1, 1) + Vec3(0, 2, 0)), std::numbers::pi, 1e-12);  // a quarter of 4 pi
  EXPECT_NEAR(travel.normalised(from, Vec3(1, 1, 1) + Vec3(0, 2, 0)), 0.5, 1e-12);
  EXPECT_NEAR(travel.normalised(from, Vec3(1, 1, 1) - Vec3(2, 0, 0)), 1, 1e-12);
  EXPECT_EQ(travel.distance(from, from), 0);
}

TEST(Travel, GoesStraightElsewhere) {
  const Travel travel{Travel::Path::straight, Vec3::Zero(), 1};
  EXPECT_DOUBLE_EQ(travel.distance({0, 0, 0}, {3, 4, 0}), 5);
}

TEST(Travel, KeepsSmallAnglesExact) {
  EXPECT_NEAR(angle_seen_from(Vec3::Zero(), {1, 0, 0}, {1, 1e-9, 0}), 1e-9, 1e-18);
  EXPECT_EQ(angle_seen_from(Vec3::Zero(), Vec3::Zero(), {1, 0, 0}), 0);
}

}  // namespace
}  // namespace vantage
