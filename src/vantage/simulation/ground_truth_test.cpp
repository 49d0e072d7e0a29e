#include "vantage/simulation/ground_truth.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>

#include "vantage/core/error.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/simulation/objects.hpp"

namespace vantage {
namespace {

/// Two unit squares that face each other's backs: one at z = 0.05 facing up, one at z = -0.05 facing down. Voxels of
/// 0.1 m, so that each square lies in the middle of a layer of 10 x 10.
TriangleMesh two_plates() {
  return {{{-0.5, -0.5, 0.05},
           {0.5, -0.5, 0.05},
           {0.5, 0.5, 0.05},
           {-0.5, 0.5, 0.05},
           {-0.5, -0.5, -0.05},
           {0.5, -0.5, -0.05},
           {0.5, 0.5, -0.05},
           {-0.5, 0.5, -0.05}},
          {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}};
}

constexpr int upper_layer = 10;
constexpr int lower_layer = 9;

class Plates : public testing::Test {
 protected:
  Plates() : scanner(two_plates()) {
    options.voxel_length = 0.1;
    options.scene_size = Index3::Constant(40);
    options.enclosure_size = Index3::Constant(20);
  }

  [[nodiscard]] GroundTruth truth_from(const std::vector<Vec3>& positions) const {
    std::vector<View> views;
    for (const Vec3& position : positions) views.push_back(view_towards(position, Vec3::Zero()));
    return {scanner, options.grid(), options.enclosure(), RangeCamera{}, views, {.samples = 100'000}};
  }
  [[nodiscard]] VoxelMap map_with(int layer, int columns) const {
    VoxelMap map(options);
    for (int y = 5; y < 15; ++y) {
      for (int x = 5; x < 5 + columns; ++x) {
        map.set_label(map.enclosure().min + Index3(x, y, layer), Label::occupied);
      }
    }
    return map;
  }

  RangeScanner scanner;
  SceneOptions options;
};

TEST_F(Plates, CoverageCountsAreaInVisibleVoxels) {
  const GroundTruth truth = truth_from({{0, 0, 2}});  // sees the upper plate only
  EXPECT_EQ(truth.visible_voxels(), 100);
  EXPECT_EQ(truth.coverage(VoxelMap(options)), 0);
  EXPECT_EQ(truth.coverage_all(VoxelMap(options)), 0);
  EXPECT_EQ(truth.coverage(map_with(upper_layer, 10)), 1);
  EXPECT_NEAR(truth.coverage_all(map_with(upper_layer, 10)), 0.5, 1e-4);
  EXPECT_NEAR(truth.coverage(map_with(upper_layer, 3)), 0.3, 1e-3);
  EXPECT_NEAR(truth.coverage_all(map_with(upper_layer, 3)), 0.15, 5e-4);
  // What no view can see counts in neither.
  EXPECT_EQ(truth.coverage(map_with(lower_layer, 10)), 0);
  EXPECT_EQ(truth.coverage_all(map_with(lower_layer, 10)), 0);
}

TEST_F(Plates, EveryViewAddsToWhatIsVisible) {
  const GroundTruth truth = truth_from({{0, 0, 2}, {0, 0, -2}});
  EXPECT_EQ(truth.visible_voxels(), 200);
  EXPECT_NEAR(truth.coverage(map_with(lower_layer, 10)), 0.5, 1e-4);
  const Index3 first = options.enclosure().min + Index3(5, 5, lower_layer);
  EXPECT_TRUE(truth.is_visible(first));
  EXPECT_FALSE(truth.is_visible(first - Index3(1, 0, 0)));
  EXPECT_FALSE(truth.is_visible(Index3(0, 0, 0)));
}

TEST_F(Plates, NothingVisibleIsNoCoverage) {
  const GroundTruth truth = truth_from({});
  EXPECT_EQ(truth.visible_voxels(), 0);
  EXPECT_EQ(truth.coverage(map_with(upper_layer, 10)), 0);
}

TEST_F(Plates, AccuracyIsTheDistanceToTheSurface) {
  const GroundTruth truth = truth_from({{0, 0, 2}});
  EXPECT_EQ(truth.accuracy({}).root_mean_square, 0);
  PointCloud cloud;
  for (int i = 0; i < 96; ++i) cloud.add({0.01 * (i - 48), 0, 0.05}, Vec3::UnitZ());  // exact
  for (int i = 0; i < 4; ++i) cloud.add({0.1 * i, 0.2, 0.05 + 0.03}, Vec3::UnitZ());  // 3 cm off
  const Accuracy accuracy = truth.accuracy(cloud);
  EXPECT_NEAR(accuracy.root_mean_square, 0.03 * 0.2, 1e-12);
  EXPECT_NEAR(accuracy.percentile_95, 0, 1e-12);
  EXPECT_NEAR(accuracy.maximum, 0.03, 1e-12);
  cloud.add({0, 0, -0.05 - 0.04}, -Vec3::UnitZ());
  cloud.add({0, 0, -0.05 - 0.04}, -Vec3::UnitZ());
  EXPECT_NEAR(truth.accuracy(cloud).percentile_95, 0.03, 1e-12);  // 97th of 102
}

TEST_F(Plates, CompletenessCountsTheSurfaceNearPoints) {
  const GroundTruth truth = truth_from({{0, 0, 2}});
  EXPECT_EQ(truth.completeness({}).all, 0);
  PointCloud cloud;  // a lattice of 1 cm over the half x < 0 of the upper plate
  for (int y = -50; y <= 50; ++y) {
    for (int x = -50; x <= 0; ++x) cloud.add({0.01 * x, 0.01 * y, 0.05}, Vec3::UnitZ());
  }
  // All of that half lies within 8 mm of a point, and a strip of 8 mm beyond it, scalloped by the lattice.
  const Completeness near = truth.completeness(cloud, 0.008);
  EXPECT_NEAR(near.visible, 0.507, 0.001);
  EXPECT_NEAR(near.all, near.visible / 2, 1e-4);
  // Within 5 mm each point owns a disc: pi/4 of the lattice cell.
  EXPECT_NEAR(truth.completeness(cloud, 0.005).visible, 0.5 * std::numbers::pi / 4, 0.006);
  EXPECT_THROW((void)truth.completeness(cloud, 0), InputError);
}

TEST_F(Plates, RefusesAMapOfAnotherScene) {
  const GroundTruth truth = truth_from({{0, 0, 2}});
  SceneOptions other = options;
  other.enclosure_size = Index3::Constant(18);
  EXPECT_THROW((void)truth.coverage(VoxelMap(other)), InputError);
  other = options;
  other.center = Vec3(0.01, 0, 0);
  EXPECT_THROW((void)truth.coverage(VoxelMap(other)), InputError);
}

TEST_F(Plates, RefusesAScanWithoutSamples) {
  EXPECT_THROW(GroundTruth(scanner, options.grid(), options.enclosure(), RangeCamera{}, {}, {.samples = 0}),
               InputError);
}

TEST(GroundTruth, AllCandidatesCoverEverythingVisible) {
  const RangeScanner scanner(make_object("mug"));
  const SceneOptions options;
  const Candidates candidates = view_sphere(20, 2, Vec3::Zero());
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {160, 160});
  const GroundTruth truth(scanner, options.grid(), options.enclosure(), camera, visibility_views(candidates));
  VoxelMap map(options);
  double last = 0;
  for (const View& view : candidates.views) {
    const RangeImage image = scanner.scan(camera, view);
    integrate(map, image, range_image_normals(image), view);
    EXPECT_GE(truth.coverage(map), last);
    last = truth.coverage(map);
  }
  EXPECT_EQ(last, 1);
  EXPECT_EQ(truth.visible_voxels(), map.count(Label::occupied));
  EXPECT_LT(truth.coverage_all(map), 1);
  EXPECT_GT(truth.coverage_all(map), 0.95);
}

TEST(GroundTruth, SameForAnyNumberOfThreads) {
  const RangeScanner scanner(make_object("mug"));
  const SceneOptions options;
  const Candidates candidates = view_sphere(20, 2, Vec3::Zero());
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {80, 80});
  VoxelMap map(options);
  const RangeImage image = scanner.scan(camera, candidates.views[3]);
  integrate(map, image, {}, candidates.views[3]);
  Random random(2);
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) cloud.add(0.4 * random.unit_vector(), Vec3::Zero());
  std::vector<std::array<double, 5>> results;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const GroundTruth truth(scanner, options.grid(), options.enclosure(), camera, candidates.views,
                            {.samples = 20'000});
    const Accuracy accuracy = truth.accuracy(cloud);
    results.push_back({truth.coverage(map), truth.coverage_all(map), accuracy.root_mean_square, accuracy.percentile_95,
                       truth.completeness(cloud, 0.02).all});
  }
  EXPECT_GT(results[0][0], 0.1);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(VisibilityViews, EverySixteenthOfACube) {
  EXPECT_EQ(visibility_views(view_sphere(80, 2, Vec3::Zero())).size(), 80U);
  const Candidates cube = view_cube(17, Vec3::Constant(4.1), 0.82, 1.9, Vec3::Zero());
  ASSERT_EQ(cube.views.size(), 1932U);
  const auto views = visibility_views(cube);
  ASSERT_EQ(views.size(), 121U);
  EXPECT_EQ(views[1].position(), cube.views[16].position());
}

}  // namespace
}  // namespace vantage
