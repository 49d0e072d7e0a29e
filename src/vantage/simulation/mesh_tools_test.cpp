#include "vantage/simulation/mesh_tools.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A box with edges 1, 2 and 3 from the origin, facing outwards.
TriangleMesh box() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back((i & 1) * 1.0, (i >> 1 & 1) * 2.0, (i >> 2) * 3.0);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

std::string complaint(const TriangleMesh& mesh) {
  return message_of([&] { check_mesh(mesh, "cup.ply"); });
}

TEST(CheckMesh, NamesTheMeshAndWhatIsWrong) {
  EXPECT_NO_THROW(check_mesh(box(), "box"));

  TriangleMesh points = box();
  points.triangles.clear();
  EXPECT_THAT(complaint(points), AllOf(HasSubstr("cup.ply"), HasSubstr("8 vertices and no triangles")));

  TriangleMesh beyond = box();
  beyond.triangles[3] = {4, 8, 6};
  EXPECT_THAT(complaint(beyond), AllOf(HasSubstr("triangle 3 has the corner 8"), HasSubstr("must be 0 to 7")));

  TriangleMesh negative = box();
  negative.triangles[0] = {-1, 2, 3};
  EXPECT_THAT(complaint(negative), HasSubstr("triangle 0 has the corner -1"));

  TriangleMesh not_a_number = box();
  not_a_number.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaint(not_a_number), AllOf(HasSubstr("vertex 5"), HasSubstr("nan"), HasSubstr("finite")));

  TriangleMesh point = box();
  for (Vec3& vertex : point.vertices) vertex = Vec3(1, 1, 1);
  EXPECT_THAT(complaint(point), HasSubstr("zero extent"));

  TriangleMesh line = box();
  for (Vec3& vertex : line.vertices) vertex = Vec3(vertex.x(), 0, 0);
  EXPECT_THAT(complaint(line), HasSubstr("no area"));

  TriangleMesh huge = box();
  for (Vec3& vertex : huge.vertices) vertex *= 1e7;
  EXPECT_THAT(complaint(huge), AllOf(HasSubstr("largest side of the mesh is 30000000"), HasSubstr("unit")));

  TriangleMesh tiny = box();
  for (Vec3& vertex : tiny.vertices) vertex *= 1e-8;
  EXPECT_THAT(complaint(tiny), HasSubstr("largest side of the mesh is 3e-08"));
}

TEST(CentredAndScaled, PutsTheBoxAroundTheOrigin) {
  const Box3 bounds = centred_and_scaled(box(), 0.6).box();
  EXPECT_TRUE(bounds.min().isApprox(Vec3(-0.1, -0.2, -0.3), 1e-15));
  EXPECT_TRUE(bounds.max().isApprox(Vec3(0.1, 0.2, 0.3), 1e-15));
}

TEST(CentredAndScaled, RefusesAbsurdSizes) {
  for (const double size : {0.0, -1.0, 1e-4, 2e3, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(message_of([&] { (void)centred_and_scaled(box(), size); }), HasSubstr("size = ")) << size;
  }
  EXPECT_THAT(message_of([] { (void)centred_and_scaled({}, 1); }), HasSubstr("zero extent"));
}

TEST(MeshMeasures, OfABox) {
  EXPECT_DOUBLE_EQ(surface_area(box()), 2 * (1 * 2 + 2 * 3 + 1 * 3));
  EXPECT_DOUBLE_EQ(signed_volume(box()), 6);
}

TEST(SampleSurface, SpreadsPointsByArea) {
  Random random(3);
  const int count = 22'000;  // 1000 per unit of area
  const auto samples = sample_surface(box(), count, random);
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(count));
  int on_top = 0, on_top_near_corner = 0;
  for (const MeshSample& sample : samples) {
    EXPECT_GE(sample.triangle, 0);
    const Vec3 inside = sample.point - 1e-9 * sample.normal;
    EXPECT_TRUE((inside.array() > 0).all() && inside.x() < 1 && inside.y() < 2 && inside.z() < 3)
        << sample.point.transpose();
    if (sample.normal.z() > 0.5) {
      ++on_top;
      if (sample.point.x() < 0.5 && sample.point.y() < 0.5) ++on_top_near_corner;
    }
  }
  // Independent points would scatter by 43 and 15; equal steps of area leave a rest of one per triangle.
  EXPECT_NEAR(on_top, 2000, 2);
  EXPECT_NEAR(on_top_near_corner, 250, 8);
}

TEST(SampleSurface, IsTheSameForTheSameSeed) {
  Random one(5), same(5), other(6);
  const auto a = sample_surface(box(), 100, one);
  const auto b = sample_surface(box(), 100, same);
  const auto c = sample_surface(box(), 100, other);
  int different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].point, b[i].point);
    if (a[i].point != c[i].point) ++different;
  }
  EXPECT_EQ(different, 100);
}

TEST(SampleSurface, RefusesNothing) {
  Random random(1);
  EXPECT_THAT(message_of([&] { (void)sample_surface(box(), 0, random); }), HasSubstr("surface samples = 0"));
  EXPECT_THAT(message_of([&] { (void)sample_surface({}, 5, random); }), HasSubstr("no area"));
}

}  // namespace
}  // namespace vantage
