#include "vantage/visibility/visibility.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <numeric>

#include "support/random_scenes.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using ::testing::ElementsAre;

/// 9 x 9 x 9 empty voxels of 0.1 m around the world's origin.
VoxelMap empty_map() {
  VoxelMap map({Vec3::Constant(-0.45), 0.1, Index3::Constant(9)}, {Index3::Zero(), Index3::Constant(8)});
  test::set_labels(map, [](const Index3&) { return Label::empty; });
  return map;
}

/// Looks along +x from 2 m in front of the middle voxel (4, 4, 4); sensor right is -y, down is -z.
View view_along_x() { return view_towards(Vec3(-2, 0, 0), Vec3::Zero()); }

RangeCamera camera_of(int side) { return camera_from_apertures(radians(30), radians(30), {side, side}); }

Visibility see(const VoxelMap& map, const RangeCamera& camera, const View& view) {
  const Visibility seen = VisibilityEvaluator(map).see(camera, view, camera.resolution);
  EXPECT_EQ(seen, see_exactly(map, camera, view, camera.resolution));
  return seen;
}

TEST(Visibility, CountsEachLabelOnceAndTheRays) {
  VoxelMap map = empty_map();
  map.add_point({4, 4, 4}, Vec3(-1, 0, 0), 1);
  map.set_label({4, 2, 4}, Label::occplane);
  map.set_label({4, 6, 4}, Label::unmarked);
  map.set_label({4, 4, 6}, Label::unmarked);
  map.set_label({4, 4, 2}, Label::occluded);
  const Visibility seen = see(map, camera_of(101), view_along_x());
  EXPECT_EQ(seen.rays, 101 * 101);
  EXPECT_EQ(seen.occupied, 1);
  EXPECT_EQ(seen.occplane, 1);
  EXPECT_EQ(seen.unmarked, 2);
  EXPECT_EQ(seen.occluded, 1);
  EXPECT_EQ(from_fixed_point(seen.cosine_sum), 1);
}

TEST(Visibility, SurfacesThatFaceAwayAddNothingToTheQuality) {
  VoxelMap map = empty_map();
  map.add_point({4, 4, 4}, Vec3(1, 0, 0), 1);
  map.add_point({4, 6, 4}, Vec3(-0.6, 0.8, 0), 1);
  map.add_point({4, 2, 4}, Vec3::Zero(), 0);
  const Visibility seen = see(map, camera_of(101), view_along_x());
  EXPECT_EQ(seen.occupied, 3);
  EXPECT_NEAR(from_fixed_point(seen.cosine_sum), 0.6, 1e-9);
}

TEST(Visibility, TheFirstNonEmptyVoxelHidesWhatLiesBehind) {
  VoxelMap map = empty_map();
  map.set_label({3, 4, 4}, Label::occluded);
  map.set_label({5, 4, 4}, Label::occplane);
  const RangeCamera one_ray = camera_of(1);
  EXPECT_EQ(see(map, one_ray, view_along_x()).occplane, 0);
  EXPECT_EQ(see(map, one_ray, view_along_x()).occluded, 1);
  EXPECT_THAT(VisibilityEvaluator(map).visible_voxels(one_ray, view_along_x(), {1, 1}), ElementsAre(Index3(3, 4, 4)));
  map.set_label({3, 4, 4}, Label::empty);
  EXPECT_EQ(see(map, one_ray, view_along_x()).occplane, 1);
}

TEST(Visibility, DepthLimitsCutWholeVoxelsAndParts) {
  VoxelMap map = empty_map();
  map.set_label({2, 4, 4}, Label::unmarked);  // x from -0.25 to -0.15: depth 1.75 to 1.85
  map.set_label({6, 4, 4}, Label::unmarked);  // depth 2.15 to 2.25
  RangeCamera camera = camera_of(1);
  const auto visible = [&](double near, double far) {
    camera.min_depth = near;
    camera.max_depth = far;
    see(map, camera, view_along_x());
    return VisibilityEvaluator(map).visible_voxels(camera, view_along_x(), {1, 1});
  };
  EXPECT_THAT(visible(0, 4), ElementsAre(Index3(2, 4, 4)));
  EXPECT_THAT(visible(1.8, 4), ElementsAre(Index3(2, 4, 4)));  // the near plane lies in the voxel
  EXPECT_THAT(visible(1.9, 4), ElementsAre(Index3(6, 4, 4)));
  EXPECT_THAT(visible(1.9, 2.2), ElementsAre(Index3(6, 4, 4)));
  EXPECT_THAT(visible(1.9, 2.1), ElementsAre());
  EXPECT_THAT(visible(0, 1.7), ElementsAre());
}

TEST(Visibility, VoxelsBeyondTheIncidenceLimitHideAndDoNotCount) {
  VoxelMap map = empty_map();
  map.add_point({3, 4, 4}, Vec3(-0.5, std::sqrt(0.75), 0), 1);  // 60 degrees
  map.set_label({5, 4, 4}, Label::unmarked);
  RangeCamera camera = camera_of(1);
  camera.max_incidence = radians(61);
  EXPECT_EQ(see(map, camera, view_along_x()).occupied, 1);
  camera.max_incidence = radians(59);
  EXPECT_EQ(see(map, camera, view_along_x()).occupied, 0);
  EXPECT_EQ(see(map, camera, view_along_x()).unmarked, 0);
  map.set_label({3, 4, 4}, Label::empty);
  map.add_point({3, 4, 4}, Vec3::Zero(), 0);  // without a normal it passes
  EXPECT_EQ(see(map, camera, view_along_x()).occupied, 1);
}

TEST(Visibility, FromInsideANonEmptyVoxelNothingElseIsSeen) {
  VoxelMap map = empty_map();
  test::set_labels(map, [](const Index3&) { return Label::unmarked; });
  const View inside = view_towards(Vec3(0.02, 0.01, -0.03), Vec3(1, 0, 0));
  EXPECT_THAT(VisibilityEvaluator(map).visible_voxels(camera_of(51), inside, {51, 51}), ElementsAre(Index3(4, 4, 4)));
  // On the corner of eight voxels a ray begins in one of them, by its direction; here to the positive sides.
  const View corner = view_towards(map.grid().corner({4, 4, 4}), map.grid().corner({5, 5, 5}));
  RangeCamera narrow = camera_from_apertures(radians(5), radians(5), {11, 11});
  EXPECT_THAT(VisibilityEvaluator(map).visible_voxels(narrow, corner, {11, 11}), ElementsAre(Index3(4, 4, 4)));
  EXPECT_EQ(see(map, narrow, corner).unmarked, 1);
}

TEST(Visibility, RaysOnLatticePlanesObeyTheTieRule) {
  // The middle ray of an odd grid runs exactly along the edge between four voxels.
  VoxelMap map = empty_map();
  test::set_labels(map, [](const Index3& v) { return v.x() > 2 ? Label::unmarked : Label::empty; });
  const Vec3 edge = map.grid().corner({0, 4, 4}) - Vec3(1, 0, 0);
  View view;
  view.world_from_sensor.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  view.world_from_sensor.translation() = edge;
  const std::vector<Index3> exact = visible_voxels_exactly(map, camera_of(1), view, {1, 1});
  ASSERT_EQ(exact.size(), 1U);
  for (const InstructionSet set : available_instruction_sets()) {
    EXPECT_EQ(VisibilityEvaluator(map, set).visible_voxels(camera_of(1), view, {1, 1}), exact) << name(set);
    EXPECT_EQ(VisibilityEvaluator(map, set).visible_voxels(camera_of(51), view, {51, 51}),
              visible_voxels_exactly(map, camera_of(51), view, {51, 51}));
  }
}

TEST(Visibility, EnclosuresBeyondTenBitsFallBackToRays) {
  VoxelMap map({Vec3::Zero(), 0.01, Index3(1100, 2, 2)}, {Index3::Zero(), Index3(1099, 1, 1)});
  const View view = view_towards(Vec3(-1, 0.01, 0.013), Vec3(5, 0.01, 0.01));
  EXPECT_EQ(see(map, camera_of(201), view).unmarked, 4);  // the front layer
}

TEST(Visibility, APoseThatIsNoRotationStillAgreesWithRays) {
  VoxelMap map = empty_map();
  test::set_labels(map, [](const Index3&) { return Label::unmarked; });
  View squeezed = view_along_x();
  squeezed.world_from_sensor.linear().col(0) *= 0.5;
  EXPECT_GT(see(map, camera_of(31), squeezed).unmarked, 0);
  View flat = view_along_x();
  flat.world_from_sensor.linear().col(1).setZero();  // all rays in one plane: nothing to project
  EXPECT_GT(see(map, camera_of(31), flat).unmarked, 0);
}

/// Maps of 33 to 48 voxels per side in fine ray grids: most voxels take the vectorised path.
TEST(Visibility, LargeScenesAgreeWithExactRays) {
  constexpr int scenes = 48;
  Random random(23);
  std::int64_t voxels = 0;
  int compared = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    const int side = 33 + random.index(16);
    VoxelMap map({Vec3::Constant(-0.01 * side), 0.02, Index3(side, side + 2, side - 3)},
                 {Index3::Zero(), Index3(side - 1, side + 1, side - 4)});
    test::set_labels(map, [&](const Index3& v) {
      const double distance = (map.grid().center(v) - 0.02 * Vec3(1, 2, 3)).norm() / (0.01 * side);
      if (distance > 0.9) return random.uniform() < 0.01 ? Label::occplane : Label::empty;
      return distance > 0.8 ? Label::occupied : Label::unmarked;
    });
    test::set_normals(map, random);
    View view = test::random_view(map, random, test::stands[scene % 4]);
    if (scene % 2 == 0) {
      view = view_towards(random.uniform(1, 3) * random.unit_vector(), 0.1 * random.unit_vector());
    }
    RangeCamera camera = camera_of(100 + random.index(60));
    if (scene % 3 == 0) camera.right *= 1.7;
    const std::vector<Index3> exact = visible_voxels_exactly(map, camera, view, camera.resolution);
    for (const InstructionSet set : available_instruction_sets()) {
      ASSERT_EQ(VisibilityEvaluator(map, set).visible_voxels(camera, view, camera.resolution), exact)
          << name(set) << ", scene " << scene;
      ++compared;
    }
    voxels += static_cast<std::int64_t>(exact.size());
  }
  EXPECT_EQ(compared, scenes * static_cast<int>(available_instruction_sets().size()));
  EXPECT_GT(voxels, 200 * scenes);
}

TEST(Visibility, TheNumberOfThreadsChangesNothing) {
  Random random(5);
  const VoxelMap map = test::random_map(random, test::MapKind::blobs);
  const std::vector<View> views = view_sphere(80, 50 * map.grid().length, map.enclosure_center()).views;
  const RangeCamera camera = camera_of(40);
  const Resolution resolutions[] = {camera.resolution};
  const VisibilityEvaluator evaluator(map);
  const std::vector<Visibility> parallel = evaluator.see(camera, views, resolutions);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(evaluator.see(camera, views, resolutions), parallel);
  EXPECT_THROW((void)evaluator.see(camera, views, std::span<const Resolution>()), InputError);
}

class SeeUntil : public ::testing::Test {
 protected:
  SeeUntil() { std::iota(order_.rbegin(), order_.rend(), std::size_t{0}); }

  using Clock = std::chrono::steady_clock;
  VoxelMap map_ = VoxelMap(SceneOptions{.scene_size = Index3::Constant(41), .enclosure_size = Index3::Constant(21)});
  RangeCamera camera_ = camera_of(60);
  std::vector<View> views_ = view_sphere(80, 2, Vec3::Zero()).views;
  std::vector<Resolution> resolutions_{camera_.resolution};
  std::vector<std::size_t> order_ = std::vector<std::size_t>(80);
};

TEST_F(SeeUntil, EvaluatesAllViewsWhereThereIsTime) {
  const VisibilityEvaluator evaluator(map_);
  const auto seen = evaluator.see_until(Clock::now() + std::chrono::hours(1), camera_, views_, resolutions_, order_);
  const std::vector<Visibility> all = evaluator.see(camera_, views_, resolutions_);
  ASSERT_EQ(seen.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(seen[i], all[i]);
}

TEST_F(SeeUntil, EvaluatesNothingPastTheDeadline) {
  const auto seen = VisibilityEvaluator(map_).see_until(Clock::now() - std::chrono::seconds(1), camera_, views_,
                                                        resolutions_, order_);
  EXPECT_THAT(seen, ::testing::Each(std::nullopt));
}

TEST_F(SeeUntil, AnInterruptedEvaluationHoldsOnlyRightCountsOfTheFirstViews) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const VisibilityEvaluator evaluator(map_);
  const std::vector<Visibility> all = evaluator.see(camera_, views_, resolutions_);
  const Clock::time_point begin = Clock::now();
  (void)evaluator.see(camera_, views_, resolutions_);
  const Clock::duration whole = Clock::now() - begin;
  const auto seen = evaluator.see_until(Clock::now() + whole / 4, camera_, views_, resolutions_, order_);
  bool is_done = true;
  for (const std::size_t i : order_) {
    if (seen[i]) {
      EXPECT_EQ(*seen[i], all[i]);
      EXPECT_TRUE(is_done) << "view " << i << " came before an earlier one of the order";
    }
    is_done = seen[i].has_value();
  }
}

TEST_F(SeeUntil, RefusesViewsThatDoNotExist) {
  const std::size_t wrong[] = {80};
  EXPECT_THROW((void)VisibilityEvaluator(map_).see_until(Clock::now(), camera_, views_, resolutions_, wrong),
               InputError);
}

}  // namespace
}  // namespace vantage
