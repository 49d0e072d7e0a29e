#include "vantage/map/integrator.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "support/analytic_scene.hpp"
#include "support/random_scenes.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using test::AnalyticScene;

template <class Visit>
void for_each_voxel(const VoxelMap& map, const Visit& visit) {
  const auto [min, max] = map.enclosure();
  for (int z = min.z(); z <= max.z(); ++z) {
    for (int y = min.y(); y <= max.y(); ++y) {
      for (int x = min.x(); x <= max.x(); ++x) visit(Index3(x, y, z));
    }
  }
}

std::int64_t differing_evidence(const VoxelMap& a, const VoxelMap& b) {
  std::int64_t differing = 0;
  for_each_voxel(a, [&](const Index3& voxel) { differing += a.evidence(voxel) == b.evidence(voxel) ? 0 : 1; });
  return differing;
}

std::int64_t differing_voxels(const VoxelMap& a, const VoxelMap& b) {
  std::int64_t differing = 0;
  for (std::size_t word = 0; word < a.layout().words(); ++word) {
    differing += std::popcount(
        (a.occupied().words[word] ^ b.occupied().words[word]) | (a.empty().words[word] ^ b.empty().words[word]) |
        (a.hidden().words[word] ^ b.hidden().words[word]) | (a.occplane().words[word] ^ b.occplane().words[word]));
  }
  if (a.rule() == MapRule::evidence) differing += differing_evidence(a, b);
  return differing;
}

void expect_same_surfaces(const VoxelMap& a, const VoxelMap& b) {
  for (const Index3& voxel : a.occupied_voxels()) {
    ASSERT_EQ(a.surface(voxel)->normal_sum, b.surface(voxel)->normal_sum) << voxel.transpose();
    ASSERT_EQ(a.surface(voxel)->quality, b.surface(voxel)->quality) << voxel.transpose();
  }
}

RangeCamera camera_of(Resolution resolution) {
  RangeCamera camera;
  camera.resolution = resolution;
  return camera;
}

/// Random maps, objects, cameras and views, with as many awkward ones as even ones.
class RandomScenes {
 public:
  explicit RandomScenes(std::uint64_t seed) : random(seed) {}

  [[nodiscard]] VoxelMap map() {
    Index3 size(side(), side(), side());
    if (random.uniform() < 0.2) size.x() = 60 + random.index(80);  // rows of one, two and three words
    const Index3 margin(random.index(4), random.index(4), random.index(4));
    Grid grid;
    grid.length = one_of({0.02, 0.025, 0.03125, random.uniform(0.01, 0.04)});
    grid.size = size + 2 * margin;
    grid.min = random.uniform() < 0.5 ? Vec3(-0.5 * grid.length * grid.size.cast<double>()) : Vec3(random.normal3());
    return {
        grid, {margin, margin + size - Index3::Ones()}, random.uniform() < 0.5 ? MapRule::paper : MapRule::evidence};
  }

  [[nodiscard]] AnalyticScene objects(const Box3& around) {
    AnalyticScene scene;
    const auto place = [&] { return Vec3(around.center() + 0.5 * random.normal3().cwiseProduct(around.sizes())); };
    const double scale = around.sizes().minCoeff() + 0.2 * around.sizes().maxCoeff();
    for (int i = random.index(4); i > 0; --i) scene.spheres.push_back({place(), random.uniform(0.1, 0.6) * scale});
    for (int i = random.index(4); i > 0; --i) {
      const Vec3 corner = place();
      scene.boxes.emplace_back(corner, corner + random.normal3().cwiseAbs() * 0.5 * scale);
    }
    return scene;
  }

  [[nodiscard]] RangeCamera camera(double distance) {
    RangeCamera camera;
    camera.resolution = {20 + random.index(140), 20 + random.index(100)};
    if (random.uniform() < 0.3) camera.resolution = {3 + random.index(20), 3 + random.index(20)};
    if (random.uniform() < 0.3) camera.resolution = {1 + 2 * random.index(60), 1 + 2 * random.index(60)};
    const double widest = random.uniform() < 0.1 ? 3 : 0.6;
    camera.left = -random.uniform(0.1, widest);
    camera.right = random.uniform() < 0.5 ? -camera.left : random.uniform(-0.05, widest);
    camera.top = -random.uniform(0.1, widest);
    camera.bottom = random.uniform() < 0.5 ? -camera.top : random.uniform(-0.05, widest);
    if (random.uniform() < 0.2) camera.min_depth = distance * random.uniform(0.5, 1.2);
    camera.max_depth = random.uniform() < 0.3 ? camera.min_depth + distance * random.uniform(0.2, 1.5) : 50;
    if (random.uniform() < 0.05) camera.max_depth = std::numeric_limits<double>::infinity();
    return camera;
  }

  [[nodiscard]] View view(const VoxelMap& map) {
    if (random.uniform() < 0.4) return test::random_view(map, random, test::stands[random.index(4)]);
    const Box3 box = map.grid().box(map.enclosure());
    const double radius = 0.5 * box.diagonal().norm();
    const double distance = radius * random.uniform(0.7, 3.5);
    return view_towards(box.center() + distance * random.unit_vector(), box.center() + 0.3 * radius * random.normal3());
  }

  template <class Value>
  [[nodiscard]] Value one_of(std::initializer_list<Value> values) {
    return values.begin()[random.index(static_cast<int>(values.size()))];
  }

  Random random;

 private:
  [[nodiscard]] int side() { return 1 + random.index(random.uniform() < 0.3 ? 6 : 32); }
};

TEST(Integrator, DoesToTheLastBitWhatExactRaysDo) {
  // Thousands of scans of a fraction of a millisecond; threads have a test of their own.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  RandomScenes scenes(61);
  Random& random = scenes.random;
  Integrator integrator;
  int compared_scans = 0;
  int fast_scans = 0;
  int lattice_points = 0;
  std::int64_t taken_back = 0;
  std::int64_t contradicted = 0;
  std::array<std::int64_t, 5> labels{};
  for (int scene = 0; scene < 1500; ++scene) {
    VoxelMap fast = scenes.map();
    VoxelMap exact = fast;
    const Box3 box = fast.grid().box(fast.enclosure());
    const AnalyticScene objects = scenes.objects(box);
    for (int scan = 1 + random.index(4); scan > 0; --scan) {
      const View view = scenes.view(fast);
      const RangeCamera camera = scenes.camera((box.center() - view.position()).norm());
      RangeImage image = objects.scan(camera, view);
      test::disturb(image, scenes.one_of({0.0, 0.002, 0.02}), scenes.one_of({0.0, 0.05, 0.9}),
                    scenes.one_of({0.0, 0.02, 0.5}), random);
      const std::vector<Vec3f> normals = random.uniform() < 0.2 ? std::vector<Vec3f>() : range_image_normals(image);
      const QualityReference reference = scenes.one_of({QualityReference::axis, QualityReference::ray});
      const IntegrationReport report = integrator.integrate(fast, image, normals, view, reference);
      const IntegrationReport expected = integrate_exactly(exact, sight_lines(image, normals, view, reference));
      ASSERT_EQ(report.points_in_enclosure, expected.points_in_enclosure) << "scene " << scene;
      ASSERT_EQ(report.new_occupied, expected.new_occupied) << "scene " << scene;
      ASSERT_EQ(report.taken_back, expected.taken_back) << "scene " << scene;
      taken_back += report.taken_back;
      ASSERT_EQ(differing_voxels(fast, exact), 0) << "scene " << scene;
      ASSERT_NO_FATAL_FAILURE(expect_same_surfaces(fast, exact)) << "scene " << scene;
      ++compared_scans;
      if (!rays_are_faster(fast, camera, view)) ++fast_scans;
      lattice_points += static_cast<int>(report.points_in_enclosure);
    }
    for (const Label label : all_labels) labels.at(static_cast<std::size_t>(label)) += fast.count(label);
    for_each_voxel(fast, [&](const Index3& voxel) { contradicted += fast.evidence(voxel).contradiction > 0 ? 1 : 0; });
  }
  EXPECT_GT(compared_scans, 3000);
  EXPECT_GT(fast_scans, 1500) << "most scans must take the path under test";
  EXPECT_GT(lattice_points, 100000);
  EXPECT_GT(taken_back, 100);
  EXPECT_GT(contradicted, 1500);
  for (const Label label : all_labels) EXPECT_GT(labels.at(static_cast<std::size_t>(label)), 20000) << name(label);
}

TEST(Integrator, AnyNumberOfThreadsGivesTheSameBits) {
  const AnalyticScene objects{{{Vec3(0.1, 0, 0), 0.3}, {Vec3(-0.3, 0.1, 0.1), 0.15}}, {}};
  const auto reconstruct = [&](std::size_t threads, MapRule rule) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    VoxelMap map{SceneOptions{.rule = rule}};
    Random random(3);
    for (const Vec3& position : {Vec3(2, 0, 0), Vec3(0, 1.5, 1.2), Vec3(-1, -1, -1.2)}) {
      const View view = view_towards(position, Vec3::Zero());
      RangeImage image = objects.scan(camera_of({200, 150}), view);
      test::disturb(image, 0.005, 0.05, 0.05, random);
      integrate(map, image, range_image_normals(image), view);
    }
    return map;
  };
  for (const MapRule rule : {MapRule::paper, MapRule::evidence}) {
    const VoxelMap alone = reconstruct(1, rule);
    const VoxelMap together = reconstruct(4, rule);
    EXPECT_EQ(differing_voxels(alone, together), 0);
    expect_same_surfaces(alone, together);
    EXPECT_GT(alone.count(Label::occupied), 2000);
  }
}

TEST(Integrator, RaysServeCoarseImagesAndCamerasInTheEnclosure) {
  const VoxelMap map{SceneOptions{}};
  const View outside = view_towards({2, 0, 0}, Vec3::Zero());
  EXPECT_FALSE(rays_are_faster(map, RangeCamera{}, outside));
  EXPECT_TRUE(rays_are_faster(map, camera_of({79, 79}), outside));
  EXPECT_TRUE(rays_are_faster(map, RangeCamera{}, view_towards({0.3, 0, 0}, Vec3::Zero())));
}

TEST(Integrator, SizesMustAgree) {
  VoxelMap map{SceneOptions{}};
  RangeImage image;
  image.depth.assign(320 * 320, 1);
  const View view = view_towards({2, 0, 0}, Vec3::Zero());
  EXPECT_THROW(integrate(map, image, std::vector<Vec3f>(7), view), InputError);
  image.depth.pop_back();
  EXPECT_THROW(integrate(map, image, {}, view), InputError);
}

TEST(Integrator, LabelsEnclosuresWhoseStepsDoNotFitIn16Bits) {
  const Grid grid{Vec3::Zero(), 0.01, Index3(16384, 16384, 2)};
  VoxelMap map(grid, grid.all());
  // Along the diagonal to a hit beyond 32767 steps.
  const Vec3 from(-0.005, -0.0051, 0.005);
  const Index3 end(16380, 16380, 0);
  const Vec3 hit = grid.center(end);
  RangeImage image{camera_from_apertures(radians(1), radians(1), {1, 1}), {}};
  image.camera.max_depth = 300;
  image.depth = {static_cast<float>((hit - from).norm())};
  const IntegrationReport report = integrate(map, image, {}, view_towards(from, hit));
  EXPECT_EQ(report.new_occupied, 1);
  EXPECT_EQ(map.occupied_voxels(), std::vector<Index3>{end});
  EXPECT_EQ(map.label({0, 0, 0}), Label::empty);
  EXPECT_EQ(map.label({16300, 16300, 0}), Label::empty);
  EXPECT_EQ(map.count(Label::occluded) + map.count(Label::occplane), 6) << "3 + 3 steps behind the hit";
  EXPECT_EQ(map.label({5, 16000, 0}), Label::unmarked);
}

TEST(Integrator, RefusesASensorFartherOffThanVoxelsCanBeCounted) {
  const Grid grid{Vec3::Zero(), 0.001, Index3(10, 10, 10)};
  VoxelMap map(grid, grid.all());
  RangeImage image{camera_from_apertures(radians(45), radians(45), {2, 2}),
                   std::vector<float>(4, RangeImage::no_return)};
  for (const double distance : {1e8, 1e20, 1e300}) {
    const View view = view_towards(Vec3(0, 0, distance), Vec3::Zero());
    EXPECT_THROW((void)integrate(map, image, {}, view), InputError);
    EXPECT_THROW((void)integrate_exactly(map, sight_lines(image, {}, view)), InputError);
  }
  EXPECT_NO_THROW((void)integrate(map, image, {}, view_towards(Vec3(0, 0, 1e5), Vec3::Zero())));
}

}  // namespace
}  // namespace vantage
