#include "vantage/sensor/organised_normals.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

TEST(OrganisedNormals, AreThoseOfASphereSeenByParallelRays) {
  // A unit sphere around the origin seen from +z, 0.02 between the cells; cells off the sphere have no point.
  const Resolution grid{81, 81};
  std::vector<std::int32_t> cells(81 * 81, -1);
  std::vector<Vec3> points, origins;
  for (int row = 0; row < 81; ++row) {
    for (int column = 0; column < 81; ++column) {
      const double x = 0.025 * (column - 40), y = 0.025 * (row - 40);
      const double square = 1 - x * x - y * y;
      if (square <= 0) continue;
      cells[static_cast<std::size_t>(row * 81 + column)] = static_cast<std::int32_t>(points.size());
      points.emplace_back(x, y, std::sqrt(square));
      origins.emplace_back(x, y, 5);
    }
  }
  const std::vector<Vec3f> normals = organised_normals(grid, cells, points, origins);
  int checked = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].z() < 0.5) continue;  // steeper, the differences are too coarse
    EXPECT_GT(normals[i].cast<double>().dot(points[i]), std::cos(radians(1))) << points[i].transpose();
    ++checked;
  }
  EXPECT_GT(checked, 3000);
}

TEST(OrganisedNormals, ThereIsNoneWhereTheNeighboursLieOnAnotherSurface) {
  // Two columns on a near plane, one far behind; the plane's normal must not lean towards it.
  const std::vector<Vec3> points{{0, 0, 1}, {0.01, 0, 1}, {0.02, 0, 2}, {0, 0.01, 1}, {0.01, 0.01, 1}, {0.02, 0.01, 2}};
  const std::vector<std::int32_t> cells{0, 1, 2, 3, 4, 5};
  const std::vector<Vec3> origin{Vec3::Zero()};
  const std::vector<Vec3f> normals = organised_normals({3, 2}, cells, points, origin);
  for (const std::size_t near : {0U, 1U, 3U, 4U}) EXPECT_TRUE(normals[near].isApprox(Vec3f(0, 0, -1), 1e-6F)) << near;
  for (const std::size_t far : {2U, 5U}) EXPECT_EQ(normals[far], Vec3f(0, 0, 0)) << far;
  EXPECT_THAT(input_error_of([&] {
                (void)organised_normals({3, 3}, cells, points, origin);
              }),
              testing::HasSubstr("6 cells for 3x3"));
}

}  // namespace
}  // namespace vantage
