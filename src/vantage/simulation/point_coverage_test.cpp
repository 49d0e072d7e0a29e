#include "vantage/simulation/point_coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// A square of 1 m in the plane z = 0.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Points 2 mm apart over [0, width] x [0, 1], 1 mm above the square.
std::vector<Vec3> strip(double width) {
  std::vector<Vec3> points;
  for (int i = 0; i <= std::lround(width / 0.002); ++i) {
    for (int j = 0; j <= 500; ++j) points.emplace_back(0.002 * i, 0.002 * j, 0.001);
  }
  return points;
}

TEST(PointCoverage, IsTheShareOfTheSurfaceWithinTheToleranceOfAnyScan) {
  PointCoverage coverage(square(), {20'000, 0.005});
  EXPECT_EQ(coverage.share(), 0);
  coverage.add({});
  coverage.add({{0.5, 0.5, 0.0051}});
  EXPECT_EQ(coverage.share(), 0) << "too far above";
  // The tolerance reaches over the strip's edge: by sqrt(5^2 - 1^2) mm = 4.9 mm.
  coverage.add(strip(0.25));
  EXPECT_NEAR(coverage.share(), 0.25 + 0.0049, 0.002);
  coverage.add(strip(0.5));
  EXPECT_NEAR(coverage.share(), 0.5 + 0.0049, 0.002);
  coverage.add(strip(0.1));
  EXPECT_NEAR(coverage.share(), 0.5 + 0.0049, 0.002) << "what was near stays so";
}

TEST(PointCoverage, MayCountWhatIsReachableAlone) {
  const PointMetric metric{20'000, 0.005};
  PointCoverage reachable(square(), metric);
  reachable.add(strip(0.5));
  PointCoverage coverage(square(), metric);
  coverage.count_only(reachable);
  coverage.add(strip(0.25));
  EXPECT_NEAR(coverage.share(), 0.2549 / 0.5049, 0.004);
  coverage.add(strip(1));
  EXPECT_EQ(coverage.share(), 1);
  EXPECT_THROW(coverage.count_only(PointCoverage(square(), {10'000, 0.005})), InputError);
}

}  // namespace
}  // namespace vantage
