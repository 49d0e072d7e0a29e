#include "vantage/report/software_renderer.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TriangleMesh sphere(double radius, int rings) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
      mesh.vertices.emplace_back(
          radius * Vec3(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      mesh.triangles.emplace_back(a, a + around, b);
      mesh.triangles.emplace_back(b, a + around, b + around);
    }
  return mesh;
}

TriangleMesh square(double half, double y) {
  return {{{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}}, {{0, 1, 2}, {0, 2, 3}}};
}

bool is_background(const Picture& picture, int x, int y) {
  return picture.at(x, y) == std::array<std::uint8_t, 3>{0xFB, 0xFB, 0xFA};
}

int covered_pixels(const Picture& picture) {
  int count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) count += is_background(picture, x, y) ? 0 : 1;
  return count;
}

TEST(SoftwareRenderer, SphereCoversTheDiscOfItsOutline) {
  PictureScene scene;
  add_mesh(scene, sphere(0.5, 90), palette::clay);
  const PictureCamera camera{.eye = {0, -3, 0}, .aperture = radians(30)};
  const Picture picture = render(scene, camera, {.width = 400, .height = 400, .samples_per_side = 1});
  // The outline of a ball is the cone whose half-angle has the sine radius/distance.
  const double tangent = std::tan(std::asin(0.5 / 3));
  const double radius = tangent / std::tan(radians(15)) * 200;
  EXPECT_NEAR(covered_pixels(picture), std::numbers::pi * radius * radius, 0.005 * std::numbers::pi * radius * radius);
  EXPECT_FALSE(is_background(picture, 200, static_cast<int>(200 - radius) + 2));
  EXPECT_TRUE(is_background(picture, 200, static_cast<int>(200 - radius) - 2));
}

TEST(SoftwareRenderer, DiscOfACloudCoversItsEllipse) {
  PictureScene scene;
  PointCloud cloud;
  cloud.add(Vec3::Zero(), Vec3(0, -std::cos(radians(60)), std::sin(radians(60))));  // seen from 60 degrees aside
  add_cloud(scene, cloud, 0.05, palette::clay);
  const PictureCamera camera{.eye = {0, -10, 0}, .aperture = radians(2)};
  const Picture picture = render(scene, camera, {.width = 300, .height = 300, .samples_per_side = 1});
  const double radius = 0.05 / 10 / std::tan(radians(1)) * 150;
  EXPECT_NEAR(covered_pixels(picture), std::numbers::pi * radius * radius / 2,
              0.02 * std::numbers::pi * radius * radius / 2);
}

TEST(SoftwareRenderer, NearerHidesFartherWhateverTheOrder) {
  for (const bool far_first : {true, false}) {
    PictureScene scene;
    const auto add = [&](bool far) {
      add_mesh(scene, square(far ? 0.5 : 0.2, far ? 1 : 0), far ? palette::blue : palette::orange);
    };
    add(far_first);
    add(!far_first);
    const Picture picture = render(scene, PictureCamera{}, {.width = 200, .height = 200});
    const auto middle = picture.at(100, 100), aside = picture.at(128, 100);
    EXPECT_GT(middle[0], middle[2]) << "orange in front";
    EXPECT_GT(aside[2], aside[0]) << "blue beside it";
  }
}

TEST(SoftwareRenderer, StrokeHasItsWidthInPixelsAndHidesBehindSolids) {
  const std::vector<Vec3> line{{-2, 0.5, 0}, {2, 0.5, 0}};
  const auto rows_of_line = [&](const PictureScene& without, int column) {
    PictureScene with = without;
    add_path(with, line, 4, palette::black);
    const RenderOptions size{.width = 200, .height = 200};
    const Picture before = render(without, PictureCamera{}, size), after = render(with, PictureCamera{}, size);
    int rows = 0;
    for (int y = 0; y < 200; ++y) rows += before.at(column, y) == after.at(column, y) ? 0 : 1;
    return rows;
  };
  PictureScene scene;
  EXPECT_EQ(rows_of_line(scene, 100), 4);
  add_mesh(scene, square(0.2, 0), palette::clay);
  EXPECT_EQ(rows_of_line(scene, 100), 0);
  EXPECT_EQ(rows_of_line(scene, 20), 4);
}

TEST(SoftwareRenderer, VoxelsHaveTheColoursOfTheirPaint) {
  VoxelMap map(SceneOptions{.scene_size = Index3::Constant(9), .enclosure_size = Index3::Constant(3)});
  PictureScene nothing;
  add_voxels(nothing, map, paint_quality(map));
  EXPECT_TRUE(nothing.facets.empty());
  map.add_point({3, 3, 3}, Vec3(0, -1, 0), 0.25);
  map.add_point({4, 3, 3}, Vec3(0, -1, 0), 1.0);
  PictureScene scene;
  add_voxels(scene, map, paint_quality(map));
  EXPECT_EQ(scene.facets.size(), 20U);  // ten outer faces of two joined cubes
  EXPECT_EQ(scene.facets.front().color, sequential_color(0.25));
  EXPECT_EQ(scene.facets.back().color, sequential_color(1));
  EXPECT_NEAR(scene.solid_box().volume(), 2 * std::pow(0.02, 3), 1e-11);  // corners are floats
}

TEST(SoftwareRenderer, ShadeDarkensHollowsAndTheFloorUnderThings) {
  PictureScene scene;
  add_mesh(scene, sphere(0.5, 40), palette::clay);
  const SkyLight sky(scene);
  const PictureCamera camera{.eye = {0, -4, 2}};
  const SkyLight::Lamps lamps = sky.lamps(camera.world_from_camera(), Vec3::UnitZ());
  const Vec3f up = Vec3f::UnitZ();
  const float free = sky.unobstructed(up, lamps).sum();
  EXPECT_LT(sky.arriving({0, 0, -0.52F}, up, lamps).sum(), 0.5F * free);
  EXPECT_NEAR(sky.arriving({0, 0, 0.5F}, up, lamps).sum(), free, 0.02F * free);
  EXPECT_NEAR(sky.arriving({0, 0, 30}, up, lamps).sum(), free, 1e-4F * free);
  const RenderOptions floor{.width = 120, .height = 120, .floor = -0.5};
  EXPECT_GT(covered_pixels(render(scene, sky, camera, floor)),
            covered_pixels(render(scene, sky, camera, {.width = 120, .height = 120})));
}

TEST(SoftwareRenderer, GivesTheSameBytesWithAnyNumberOfThreads) {
  PictureScene scene;
  add_mesh(scene, sphere(0.5, 30), palette::clay);
  add_camera(scene, view_towards({0, -1.5, 1}, Vec3::Zero()), RangeCamera{}, 0.2, palette::blue);
  add_path(scene, arc({0, -1.5, 1}, {1, 0, 1}, Vec3::Zero()), 2, palette::vermillion);
  scene.badges.push_back({{1, 0, 1}, 12, palette::blue});
  const auto picture = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return png_bytes(
        render(scene, camera_around(scene, {0.4, -1, 0.4}, 1.5), {.width = 240, .height = 160, .floor = -0.5}));
  };
  const std::string one = picture(1);
  EXPECT_EQ(picture(2), one);
  EXPECT_EQ(picture(8), one);
}

TEST(CameraAround, HasEverythingInThePictureAndFillsIt) {
  const std::vector<Vec3> points{{-1, 0, 0}, {3, 0.5, 0.2}, {0, 0, 2}, {1, -1, -0.3}};
  for (const double shape : {0.5, 1.0, 2.0}) {
    const PictureCamera camera = camera_around(points, {0.3, -1, 0.4}, shape);
    const Pose camera_from_world = camera.world_from_camera().inverse();
    double widest = 0;
    for (const Vec3& point : points) {
      const Vec3 p = camera_from_world * point;
      ASSERT_GT(p.z(), 0);
      const double tangent = std::tan(camera.aperture / 2);
      widest = std::max({widest, std::abs(p.x() / p.z()) / (tangent * shape), std::abs(p.y() / p.z()) / tangent});
    }
    EXPECT_NEAR(widest, 1 / 1.1, 1e-9);
  }
}

TEST(CameraAround, RefusesNothing) {
  EXPECT_THAT(
      [] {
        static_cast<void>(camera_around(PictureScene{}, {0, -1, 0}, 1));
      },
      ThrowsMessage<InputError>(HasSubstr("the scene is empty")));
}

TEST(Arc, KeepsToTheSphereAndJoinsItsEnds) {
  const Vec3 center(1, 2, 3);
  const std::vector<Vec3> way = arc(center + Vec3(2, 0, 0), center + Vec3(0, 0, 2), center);
  EXPECT_TRUE(way.front().isApprox(center + Vec3(2, 0, 0)));
  EXPECT_TRUE(way.back().isApprox(center + Vec3(0, 0, 2)));
  double length = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_NEAR((way[i] - center).norm(), 2, 1e-12);
    if (i > 0) length += (way[i] - way[i - 1]).norm();
  }
  EXPECT_NEAR(length, std::numbers::pi, 0.01);
  for (const Vec3& point : arc(center + Vec3(2, 0, 0), center - Vec3(2, 0, 0), center))  // opposite ends
    EXPECT_NEAR((point - center).norm(), 2, 1e-12);
}

TEST(RenderOptions, NameTheFieldThatIsWrong) {
  EXPECT_THAT([] { RenderOptions{.width = 0}.validate(); },
              ThrowsMessage<InputError>(HasSubstr("picture size = 0x640")));
  EXPECT_THAT([] { RenderOptions{.samples_per_side = 9}.validate(); },
              ThrowsMessage<InputError>(HasSubstr("samples_per_side = 9")));
  EXPECT_THAT([] { PictureCamera{.eye = Vec3::Zero()}.validate(); }, ThrowsMessage<InputError>(HasSubstr("coincide")));
}

}  // namespace
}  // namespace vantage
