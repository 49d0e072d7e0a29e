#include "vantage/model/surface_volume.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

/// Depth along the axis at which a ray (x, y, 1) of the view meets something; infinite: nothing.
using Scene = std::function<double(const View& view, const Vec3& ray)>;

RangeImage image_of(const Scene& scene, const View& view, double sigma, Random& random) {
  RangeImage image;
  image.camera = camera_from_apertures(radians(40), radians(40), {160, 160});
  const RayGrid rays = image.camera.rays();
  for (int row = 0; row < 160; ++row) {
    for (int column = 0; column < 160; ++column) {
      const double depth = scene(view, Vec3(rays.x(column), rays.y(row), 1));
      image.depth.push_back(static_cast<float>(std::isfinite(depth) ? depth + sigma * random.normal() : depth));
    }
  }
  return image;
}

/// An axis-aligned box around the origin.
Scene box_scene(const Vec3& half) {
  return [half](const View& view, const Vec3& ray) {
    const Vec3 direction = view.world_from_sensor.linear() * ray, from = view.position();
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double a = (-half[i] - from[i]) / direction[i], b = (half[i] - from[i]) / direction[i];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? enter : std::numeric_limits<double>::infinity();
  };
}

std::vector<View> views_around(double radius) {
  std::vector<View> views;
  const double golden = (1 + std::sqrt(5.0)) / 2;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int s : {-1, 1}) {
      for (const int t : {-1, 1}) {
        Vec3 place = Vec3::Zero();
        place[(axis + 1) % 3] = s;
        place[(axis + 2) % 3] = t * golden;
        views.push_back(view_towards(radius * place.normalized(), Vec3::Zero()));
      }
    }
  }
  return views;
}

const Box3 region(Vec3::Constant(-0.3), Vec3::Constant(0.3));

SurfaceVolume scanned(const Scene& scene, double sigma, int frames = 12) {
  SurfaceVolume volume(region);
  Random random(5);
  const SensorModel sensor = sensor_with({.a = sigma});
  const std::vector<View> views = views_around(1);
  for (int i = 0; i < frames; ++i)
    volume.fuse(scan_of(image_of(scene, views[static_cast<std::size_t>(i)], sigma, random)),
                views[static_cast<std::size_t>(i)], sensor);
  return volume;
}

double distance_to_box(const Vec3& point, const Vec3& half) {
  const Vec3 beyond = point.cwiseAbs() - half;
  const double outside = beyond.cwiseMax(0).norm();
  return outside > 0 ? outside : -beyond.maxCoeff();
}

double root_mean_square(const MeasuredMesh& mesh, const Vec3& half) {
  double squares = 0;
  for (const Vec3& vertex : mesh.mesh.vertices) squares += std::pow(distance_to_box(vertex, half), 2);
  return std::sqrt(squares / static_cast<double>(mesh.mesh.vertices.size()));
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)).norm() / 2;
  return sum;
}

TEST(SurfaceVolume, FindsABoxMoreExactlyThanOneDepthDoes) {
  const Vec3 half(0.2, 0.15, 0.1);
  const double exact_area = 8 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
  for (const double sigma : {0.0, 0.002, 0.004}) {
    const MeasuredMesh mesh = scanned(box_scene(half), sigma).mesh();
    EXPECT_LT(root_mean_square(mesh, half), std::max(0.5 * sigma, 0.0005)) << sigma;
    EXPECT_NEAR(area(mesh.mesh), exact_area, 0.05 * exact_area) << sigma;
  }
}

TEST(SurfaceVolume, KeepsTheEdgesOfABoxSharp) {
  const Vec3 half(0.2, 0.15, 0.1);
  const SurfaceVolume volume = scanned(box_scene(half), 0);
  double nearest_to_edge = 1;
  for (const Vec3& vertex : volume.mesh().mesh.vertices) {
    if (std::abs(vertex.z()) > 0.05) continue;
    nearest_to_edge = std::min(nearest_to_edge, (vertex.head<2>().cwiseAbs() - half.head<2>()).norm());
  }
  EXPECT_LT(nearest_to_edge, 0.25 * volume.cell());
}

TEST(SurfaceVolume, KeepsBothSidesOfAWallThinnerThanTheBand) {
  const Vec3 half(0.2, 0.2, 0.006);
  const double sigma = 0.002;  // the band is 3 sigma and 1.75 cells of about 4.5 mm: longer than the wall is thick
  const MeasuredMesh mesh = scanned(box_scene(half), sigma).mesh();
  EXPECT_LT(root_mean_square(mesh, half), 0.5 * sigma);
  const double exact_area = 8 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
  EXPECT_NEAR(area(mesh.mesh), exact_area, 0.05 * exact_area);
}

TEST(SurfaceVolume, StaysOpenWhereNothingWasSeen) {
  const Vec3 half(0.2, 0.15, 0.1);
  SurfaceVolume volume(region);
  Random random(5);
  const View from_above = view_towards({0, 0, 1}, Vec3::Zero());
  volume.fuse(scan_of(image_of(box_scene(half), from_above, 0, random)), from_above, SensorModel{});
  const MeasuredMesh mesh = volume.mesh();
  const double top = 4 * half.x() * half.y();
  EXPECT_NEAR(area(mesh.mesh), top, 0.1 * top);
  for (const Vec3& vertex : mesh.mesh.vertices) EXPECT_NEAR(vertex.z(), half.z(), 0.002);
}

TEST(SurfaceVolume, ClearsWhatLaterFramesLookThrough) {
  // A sheet in front of the box in the first frame only: a hand, say.
  const Vec3 half(0.1, 0.1, 0.1);
  const Scene box = box_scene(half);
  SurfaceVolume volume(region);
  Random random(5);
  const View view = view_towards({0, 0, 1}, Vec3::Zero());
  const Scene with_sheet = [&](const View& from, const Vec3& ray) {
    return std::abs(ray.x()) < 0.05 && std::abs(ray.y()) < 0.05 ? 0.8 : box(from, ray);
  };
  volume.fuse(scan_of(image_of(with_sheet, view, 0, random)), view, SensorModel{});
  const auto sheet_vertices = [&] {
    const MeasuredMesh mesh = volume.mesh();
    return std::count_if(mesh.mesh.vertices.begin(), mesh.mesh.vertices.end(),
                         [](const Vec3& v) { return v.z() > 0.15; });
  };
  EXPECT_GT(sheet_vertices(), 100);
  for (int i = 0; i < 3; ++i) volume.fuse(scan_of(image_of(box, view, 0, random)), view, SensorModel{});
  EXPECT_EQ(sheet_vertices(), 0);
}

TEST(SurfaceVolume, HasTheSameBitsForAnyNumberOfThreads) {
  const auto mesh_with = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return scanned(box_scene({0.2, 0.15, 0.1}), 0.003, 4).mesh();
  };
  const MeasuredMesh reference = mesh_with(1);
  ASSERT_FALSE(reference.empty());
  for (const std::size_t threads : {2, 8}) {
    const MeasuredMesh mesh = mesh_with(threads);
    EXPECT_EQ(mesh.mesh.vertices, reference.mesh.vertices);
    EXPECT_EQ(mesh.mesh.triangles, reference.mesh.triangles);
    EXPECT_EQ(mesh.sigma, reference.sigma);
  }
}

TEST(SurfaceVolume, StaysWithinItsBlocksByLargerCells) {
  SurfaceVolume volume(region, {.cell = 0.004, .most_blocks = 300});
  Random random(5);
  const Vec3 half(0.2, 0.15, 0.1);
  for (const View& view : views_around(1))
    volume.fuse(scan_of(image_of(box_scene(half), view, 0, random)), view, SensorModel{});
  EXPECT_LE(volume.blocks(), 300U);
  EXPECT_GE(volume.cell(), 0.008);
  EXPECT_LT(root_mean_square(volume.mesh(), half), 0.25 * volume.cell());
}

TEST(SurfaceVolume, TakesPointsWithSightLines) {
  // A line scanner's plane: points on z = 0.1 seen from above, each with its own origin.
  PointScan scan;
  for (int y = -60; y <= 60; ++y) {
    for (int x = -60; x <= 60; ++x) {
      scan.points.emplace_back(0.002 * x, 0.002 * y, 0.1);
      scan.normals.emplace_back(0, 0, 1);
      scan.origins.emplace_back(0.002 * x, 0, 1);
    }
  }
  SurfaceVolume volume(region);
  volume.fuse(scan, View{}, std::nullopt);
  EXPECT_NEAR(volume.cell(), 0.002, 1e-4);
  const MeasuredMesh mesh = volume.mesh();
  EXPECT_NEAR(area(mesh.mesh), 0.24 * 0.24, 0.05 * 0.24 * 0.24);
  for (const Vec3& vertex : mesh.mesh.vertices) EXPECT_NEAR(vertex.z(), 0.1, 0.02 * volume.cell());
}

TEST(SurfaceVolume, IsEmptyBeforeTheFirstScanAndRejectsBadOptions) {
  EXPECT_TRUE(SurfaceVolume(region).mesh().empty());
  try {
    const SurfaceVolume volume(region, {.cell = -1.0});
    FAIL() << "accepted a negative cell";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "mesh-cell = -1 m: must be positive");
  }
}

}  // namespace
}  // namespace vantage
