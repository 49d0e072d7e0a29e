#include "vantage/model/surface_mesh.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <numbers>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

PointCloud ball(double radius, int count, double noise = 0) {
  Random random(11);
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    const Vec3 normal = random.unit_vector();
    cloud.add((radius + noise * random.normal()) * normal, normal);
  }
  return cloud;
}

/// How many directed edges occur without their opposite, and how many more than once.
struct EdgeCount {
  int open = 0, doubled = 0;
};

EdgeCount count_edges(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const Index3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++directed[{triangle[k], triangle[(k + 1) % 3]}];
  }
  EdgeCount count;
  for (const auto& [edge, times] : directed) {
    count.open += directed.contains({edge.second, edge.first}) ? 0 : 1;
    count.doubled += times > 1 ? 1 : 0;
  }
  return count;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sum += mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2))) / 6;
  }
  return sum;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0);
    sum += (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a).norm() / 2;
  }
  return sum;
}

TEST(SurfaceMesh, ClosesABallFacingOutwards) {
  const TriangleMesh mesh = surface_mesh(ball(0.4, 60000), {.cell = 0.02});
  ASSERT_GT(mesh.triangles.size(), 5000U);
  EXPECT_EQ(count_edges(mesh).open, 0);
  EXPECT_EQ(count_edges(mesh).doubled, 0);
  for (const Vec3& vertex : mesh.vertices) EXPECT_NEAR(vertex.norm(), 0.4, 5e-4);
  const double exact = 4.0 / 3 * std::numbers::pi * 0.4 * 0.4 * 0.4;
  EXPECT_NEAR(volume(mesh), exact, 0.005 * exact);  // positive: triangles face outwards
}

TEST(SurfaceMesh, SmoothsNoise) {
  const TriangleMesh mesh = surface_mesh(ball(0.4, 60000, 0.003), {.cell = 0.02});
  double squares = 0;
  for (const Vec3& vertex : mesh.vertices) squares += (vertex.norm() - 0.4) * (vertex.norm() - 0.4);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.vertices.size())), 0.0015);
}

TEST(SurfaceMesh, StaysOpenWhereNothingWasSeen) {
  Random random(12);
  PointCloud square;
  for (int i = 0; i < 20000; ++i) square.add({random.uniform(), random.uniform(), 0.3}, Vec3::UnitZ());
  const TriangleMesh mesh = surface_mesh(square, {.cell = 0.05});
  EXPECT_NEAR(area(mesh), 1, 0.15);  // the border ends within a cell or so of the last points
  double facing_down = 0;            // slivers at the ragged border may turn over
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0);
    facing_down += std::max(0.0, -(mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a).z() / 2);
  }
  EXPECT_LT(facing_down, 0.002);
}

TEST(SurfaceMesh, KeepsBothSidesOfAWallTwoCellsThick) {
  Random random(13);
  PointCloud wall;
  for (int i = 0; i < 40000; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    wall.add({random.uniform(), random.uniform(), side * 0.04}, side * Vec3::UnitZ());
  }
  const TriangleMesh mesh = surface_mesh(wall, {.cell = 0.04});
  EXPECT_NEAR(area(mesh), 2, 0.25);
  for (const Vec3& vertex : mesh.vertices) EXPECT_NEAR(std::abs(vertex.z()), 0.04, 1e-3);
}

TEST(SurfaceMesh, HasTheSameBitsForAnyNumberOfThreads) {
  const PointCloud cloud = ball(0.3, 20000, 0.001);
  const TriangleMesh reference = surface_mesh(cloud);
  ASSERT_FALSE(reference.triangles.empty());
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const TriangleMesh mesh = surface_mesh(cloud);
    EXPECT_EQ(mesh.vertices, reference.vertices);
    EXPECT_EQ(mesh.triangles, reference.triangles);
  }
}

TEST(SurfaceMesh, KeepsToItsLimitOfCells) {
  const PointCloud cloud = ball(0.4, 60000);
  const TriangleMesh fine = surface_mesh(cloud, {.cell = 0.01});
  const TriangleMesh limited = surface_mesh(cloud, {.cell = 0.01, .most_cells = 2000});
  EXPECT_LT(limited.vertices.size(), fine.vertices.size() / 4);
  EXPECT_EQ(count_edges(limited).open, 0);
  EXPECT_LE(limited.vertices.size(), 2 * 2000U);
}

TEST(SurfaceMesh, IsEmptyWithoutPointsAndRejectsABadCell) {
  EXPECT_TRUE(surface_mesh(PointCloud{}).triangles.empty());
  try {
    (void)surface_mesh(PointCloud{}, {.cell = -1.0});
    FAIL() << "accepted a negative cell";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "cell = -1 m: must be positive");
  }
}

}  // namespace
}  // namespace vantage
