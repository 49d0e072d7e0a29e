#include "vantage/simulation/objects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "vantage/candidates/candidates.hpp"
#include "vantage/core/error.hpp"
#include "vantage/sensor/sight_line.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

class Objects : public testing::TestWithParam<std::string> {};

TEST_P(Objects, AreClosedAndFaceOutwards) {
  const TriangleMesh mesh = make_object(GetParam());
  EXPECT_NO_THROW(check_mesh(mesh, GetParam()));
  // A directed edge a-b occurs once, and its partner b-a once: closed, manifold and consistently turned.
  std::map<std::pair<int, int>, int> directed_edges;
  for (const Index3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++directed_edges[{t[k], t[(k + 1) % 3]}];
  }
  ASSERT_FALSE(directed_edges.empty());
  for (const auto& [edge, count] : directed_edges) {
    ASSERT_EQ(count, 1) << "edge " << edge.first << "-" << edge.second;
    ASSERT_EQ(directed_edges.count({edge.second, edge.first}), 1U) << "edge " << edge.first << "-" << edge.second;
  }
  EXPECT_GT(signed_volume(mesh), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    ASSERT_GT(area_vector(mesh, i).norm(), 1e-12) << "triangle " << i << " is degenerate";
  }
}

TEST_P(Objects, ShowTheirFrontsFromAllSides) {
  // A part that pokes through another would show its back.
  const RangeScanner scanner(make_object(GetParam()));
  int hits = 0;
  for (const View& view : view_sphere(80, 2, Vec3::Zero()).views) {
    for (int row = -12; row <= 12; ++row) {
      for (int column = -12; column <= 12; ++column) {
        const Vec3 direction = ray_direction(view.world_from_sensor.linear(), column / 40.0, row / 40.0);
        const auto hit = scanner.cast(view.position(), direction);
        if (!hit) continue;
        ++hits;
        ASSERT_LT(hit->normal.dot(direction), 0) << "at " << hit->point.transpose();
      }
    }
  }
  EXPECT_GT(hits, 80 * 25);
}

TEST_P(Objects, AreCentredAtTheirDefaultSize) {
  const Box3 bounds = make_object(GetParam()).box();
  EXPECT_LT(bounds.center().norm(), 1e-12);
  EXPECT_NEAR(bounds.sizes().maxCoeff(), default_size(GetParam()), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Objects, testing::ValuesIn(object_names()),
                         [](const auto& object) { return object.param; });

TEST(ObjectNames, UnknownOnesAreRefusedWithTheList) {
  try {
    (void)make_object("teapot");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'teapot'"));
    for (const std::string& name : object_names()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

TEST(Sphere, IsRound) {
  const TriangleMesh mesh = make_object("sphere");
  const double radius = default_size("sphere") / 2;
  for (const Vec3& vertex : mesh.vertices) ASSERT_NEAR(vertex.norm(), radius, 1e-9);
  const double volume = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  EXPECT_NEAR(signed_volume(mesh), volume, 1e-3 * volume);
}

}  // namespace
}  // namespace vantage
