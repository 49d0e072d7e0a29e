#include "vantage/model/mesh_quality.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// A tetrahedron with the corners 0, x, y, z; its slanted face is a cap.
MeasuredMesh corner_of_a_cube() {
  MeasuredMesh measured;
  measured.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  measured.sigma = {0.001F, 0.001F, 0.001F, 0.004F};
  measured.is_cap = {0, 0, 0, 1};
  return measured;
}

TEST(MeshQuality, MeasuresAreasVolumeAndDeviations) {
  const MeshQuality quality = quality_of(corner_of_a_cube(), 0.0015);
  EXPECT_EQ(quality.triangles, 4U);
  EXPECT_NEAR(quality.seen_area, 1.5, 1e-12);
  EXPECT_NEAR(quality.cap_area, std::sqrt(3) / 2, 1e-12);
  EXPECT_NEAR(quality.cap_share(), std::sqrt(3) / 2 / (1.5 + std::sqrt(3) / 2), 1e-12);
  ASSERT_TRUE(quality.volume.has_value());
  EXPECT_NEAR(*quality.volume, 1.0 / 6, 1e-12);
  EXPECT_NEAR(quality.median_sigma, 0.002, 1e-8);  // faces of 0.001, 0.002 and 0.002
  EXPECT_NEAR(quality.percentile_95_sigma, 0.002, 1e-8);
  EXPECT_NEAR(quality.accurate_area.value(), 0.5, 1e-12);
}

TEST(MeshQuality, HasNoVolumeWhereTheMeshIsOpen) {
  MeasuredMesh measured = corner_of_a_cube();
  measured.mesh.triangles.pop_back();
  measured.is_cap.pop_back();
  const MeshQuality quality = quality_of(measured);
  EXPECT_FALSE(quality.volume.has_value());
  EXPECT_FALSE(quality.accurate_area.has_value());
  EXPECT_EQ(quality.cap_area, 0);
  EXPECT_EQ(quality_of({}).triangles, 0U);
}

}  // namespace
}  // namespace vantage
