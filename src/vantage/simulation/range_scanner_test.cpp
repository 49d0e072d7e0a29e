#include "vantage/simulation/range_scanner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "vantage/candidates/candidates.hpp"
#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/triangle_geometry.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

RangeCamera camera_of(int side) { return camera_from_apertures(radians(45), radians(45), {side, side}); }

/// A square of side 2 at z = 0 that faces +z.
TriangleMesh square() { return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

TEST(RangeScanner, SphereHasTheDepthOfASphere) {
  const RangeScanner scanner(make_object("sphere"));
  const double radius = default_size("sphere") / 2;
  const RangeCamera camera = camera_of(160);
  const RayGrid rays = camera.rays();
  int hits = 0, misses = 0;
  for (const View& view : view_sphere(20, 2, Vec3::Zero()).views) {
    const RangeImage image = scanner.scan(camera, view);
    EXPECT_NO_THROW(image.validate());
    for (int row = 0; row < 160; ++row) {
      for (int column = 0; column < 160; ++column) {
        // |(x, y, 1) t - (0, 0, 2)| = radius
        const double a = rays.x(column) * rays.x(column) + rays.y(row) * rays.y(row) + 1;
        const double discriminant = 4 - a * (4 - radius * radius);
        // The mesh is a polyhedron inside the sphere, 0.1 mm from it: leave out the rim, where this decides.
        if (std::abs(discriminant) < 4e-3) continue;
        if (discriminant < 0) {
          ASSERT_EQ(image.at(column, row), RangeImage::no_return);
          ++misses;
        } else {
          const double slant = std::sqrt(discriminant) / std::sqrt(a) / radius;  // cosine of the incidence
          ASSERT_NEAR(image.at(column, row), (2 - std::sqrt(discriminant)) / a, 1.2e-4 / slant);
          ++hits;
        }
      }
    }
  }
  EXPECT_GT(hits, 20 * 4000);
  EXPECT_GT(misses, 20 * 15000);
}

TEST(RangeScanner, DepthIsThatOfTheDoublePrecisionTriangle) {
  const RangeScanner scanner(square());
  const View view = view_towards({0.3, -0.2, 1.7}, {0.1, 0.05, 0});
  const RangeCamera camera = camera_of(64);
  const RayGrid rays = camera.rays();
  const RangeImage image = scanner.scan(camera, view);
  int hits = 0;
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      const Vec3 direction = view.world_from_sensor.linear() * Vec3(rays.x(column), rays.y(row), 1);
      const double depth = -view.position().z() / direction.z();
      const Vec3 point = view.position() + depth * direction;
      const bool on_square = std::abs(point.x()) < 1 && std::abs(point.y()) < 1;
      ASSERT_EQ(image.at(column, row), on_square ? static_cast<float>(depth) : RangeImage::no_return);
      hits += on_square ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LT(hits, 64 * 64);
}

TEST(RangeScanner, DoesNotLeakThroughSharedEdges) {
  // From inside a closed surface every ray must hit; these go straight to edges. (Embree promises nothing for a ray
  // that meets a vertex to the last bit.)
  const RangeScanner scanner(make_object("sphere"));
  const TriangleMesh& mesh = scanner.mesh();
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto triangle = static_cast<std::size_t>(random.index(static_cast<int>(mesh.triangles.size())));
    const Vec3 origin = 0.2 * random.unit_vector();
    const double along = random.uniform(0.01, 0.99);
    const Vec3 on_edge = (1 - along) * mesh.corner(triangle, 0) + along * mesh.corner(triangle, 1);
    const auto hit = scanner.cast(origin, on_edge - origin);
    ASSERT_TRUE(hit) << "ray " << i << " from " << origin.transpose() << " to " << on_edge.transpose();
    EXPECT_NEAR(hit->t, 1, 1e-9);
    ++hits;
  }
  EXPECT_EQ(hits, 20'000);
}

TEST(RangeScanner, CastGivesPlaceNormalAndTriangle) {
  const RangeScanner scanner(square());
  const auto hit = scanner.cast({0.5, -0.25, 3}, {0, 0, -2});
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->t, 1.5);
  EXPECT_EQ(hit->point, Vec3(0.5, -0.25, 0));
  EXPECT_EQ(hit->normal, Vec3::UnitZ());
  EXPECT_EQ(hit->triangle, 0);
  EXPECT_FALSE(scanner.cast({0.5, -0.25, 3}, {0, 0, 2}));
  EXPECT_FALSE(scanner.cast({1.5, 0, 3}, {0, 0, -1}));
  // On the diagonal both triangles are equally near: the lowest index counts.
  EXPECT_EQ(scanner.cast({0.25, 0.25, 1}, {0, 0, -1})->triangle, 0);
  EXPECT_THROW((void)scanner.cast({0, 0, 1}, Vec3::Zero()), InputError);
}

TEST(RangeScanner, LimitsOfDepthAndIncidence) {
  const RangeScanner scanner(square());
  const View above = view_towards({0, 0, 2}, Vec3::Zero());
  RangeCamera camera = camera_of(9);
  camera.max_depth = 1.9;
  for (const float depth : scanner.scan(camera, above).depth) EXPECT_EQ(depth, RangeImage::no_return);
  camera.max_depth = 2;  // the depth of all pixels: it counts along the axis
  for (const float depth : scanner.scan(camera, above).depth) EXPECT_EQ(depth, 2);
  camera.max_depth = 5;
  camera.min_depth = 2.1;
  // A surface that is too near hides what is behind it, so that its pixels must not empty space.
  for (const float depth : scanner.scan(camera, above).depth) EXPECT_EQ(depth, RangeImage::unknown);

  camera.min_depth = 0;
  camera.max_incidence = radians(40);
  const auto depth_from = [&](double angle) {
    const View view = view_towards(2 * Vec3(std::sin(angle), 0, std::cos(angle)), Vec3::Zero());
    return scanner.scan(camera, view).at(4, 4);
  };
  EXPECT_FLOAT_EQ(depth_from(radians(39.9)), 2);
  EXPECT_EQ(depth_from(radians(40.1)), RangeImage::unknown);
}

TEST(RangeScanner, SameBitsForAnyNumberOfThreads) {
  const RangeScanner scanner(make_object("mug"));
  const View view = view_towards({1.1, -1.4, 0.9}, Vec3::Zero());
  std::vector<std::vector<float>> images;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    images.push_back(scanner.scan(camera_of(203), view).depth);
  }
  EXPECT_EQ(images[0], images[1]);
  EXPECT_EQ(images[0], images[2]);
}

TEST(RangeScanner, DistanceIsTheLeastOverAllTriangles) {
  const RangeScanner scanner(make_object("mug"));
  const TriangleMesh& mesh = scanner.mesh();
  Random random(4);
  for (int i = 0; i < 40; ++i) {
    const Vec3 point(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6));
    double least = 1e9;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const TriangleCorners corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
      least = std::min(least, (closest_point(corners, point) - point).norm());
    }
    EXPECT_DOUBLE_EQ(scanner.distance(point), least);
  }
}

TEST(ClosestPoint, InAllSevenRegions) {
  const TriangleCorners triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  EXPECT_EQ(closest_point(triangle, {1, 1, 5}), Vec3(1, 1, 0));
  EXPECT_EQ(closest_point(triangle, {-1, -2, 3}), Vec3(0, 0, 0));
  EXPECT_EQ(closest_point(triangle, {6, -1, 0}), Vec3(4, 0, 0));
  EXPECT_EQ(closest_point(triangle, {-1, 7, 1}), Vec3(0, 4, 0));
  EXPECT_EQ(closest_point(triangle, {2, -3, 1}), Vec3(2, 0, 0));
  EXPECT_EQ(closest_point(triangle, {-3, 1, 1}), Vec3(0, 1, 0));
  EXPECT_EQ(closest_point(triangle, {4, 4, 1}), Vec3(2, 2, 0));
}

TEST(RangeScanner, RefusesAMeshThatCannotBeScanned) {
  try {
    const RangeScanner scanner(TriangleMesh{});
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no triangles"));
  }
}

}  // namespace
}  // namespace vantage
