#include <gtest/gtest.h>

#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/planning/planner.hpp"
#include "vantage/utility/ray_utility.hpp"

namespace vantage {
namespace {

/// An unmarked block of 11 voxels a side: everything is to be seen.
VoxelMap unseen_block() {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(41);
  scene.enclosure_size = Index3::Constant(11);
  VoxelMap map(scene);
  // One occplane voxel on each side, so that the planner does not stop.
  for (int a = 0; a < 3; ++a) {
    for (const int side : {15, 25}) {
      Index3 voxel = Index3::Constant(20);
      voxel[a] = side;
      map.set_label(voxel, Label::occluded);
    }
  }
  map.update_occplane();
  return map;
}

const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {40, 40});

std::optional<Plan> plan_with(const Utility& utility, const VoxelMap& map) {
  Planner planner(view_sphere(20, 2.5, Vec3::Zero()), camera, {}, utility);
  return planner.next_best_view(map, planner.candidates().views[0]);
}

TEST(Utility, MayLookAtTheVoxelsOfEveryView) {
  const VoxelMap map = unseen_block();
  int asked = 0;
  const Utility number =
      voxel_utility([&](const Choice& choice, const ViewToJudge& view, std::span<const Index3> seen) {
        if (view.candidate == 0) ++asked;
        EXPECT_EQ(choice.map.label(seen.front()) == Label::empty, false);
        return static_cast<double>(seen.size());
      });
  const auto plan = plan_with(number, map);
  ASSERT_TRUE(plan);
  EXPECT_EQ(asked, 1);
  for (const Evaluation& each : plan->ranking) {
    EXPECT_EQ(each.utility, each.seen.occplane + each.seen.unmarked + each.seen.occluded + each.seen.occupied);
  }
}

/// The depth of unknown space behind each ray's first voxel, in voxels: utilities of the field look like this one.
struct UnknownVoxels {
  struct Shared {
    explicit Shared(const Choice& choice) : limit(choice.camera.max_depth) {}
    double limit;
  };
  UnknownVoxels(const Shared& map_data, const ViewToJudge&) : shared(map_data) {}
  void add(RayVoxels voxels) {
    for (const RayVoxel& voxel : voxels) {
      unknown += voxel.label != Label::empty && voxel.label != Label::occupied && voxel.entered < shared.limit ? 1 : 0;
    }
    ++rays;
  }
  [[nodiscard]] double value() const { return unknown; }

  const Shared& shared;
  double unknown = 0;
  int rays = 0;
};

TEST(Utility, MaySumAlongRays) {
  VoxelMap map = unseen_block();
  // A wall across the block that no ray along x passes.
  for (int y = 15; y <= 25; ++y) {
    for (int z = 15; z <= 25; ++z) map.set_label({18, y, z}, Label::occupied);
  }
  // Far away and narrow: all rays run along -x through the middle of the row y = z = 20.
  const View view = view_towards({3.5, 0, 0}, Vec3::Zero());
  const RangeCamera narrow = camera_from_apertures(radians(0.1), radians(0.1), {3, 3});
  const VisibilityEvaluator visibility(map);
  const std::vector<ViewToJudge> views{{.candidate = 0, .view = view, .resolution = {3, 3}, .ideal = {79, 79}}};
  const Choice choice{map, visibility, narrow, view, {}, 1, views};
  // x = 25 down to 19 are unknown, 18 is the wall.
  EXPECT_EQ(judge(ray_utility<UnknownVoxels>(), choice), std::vector<double>{9 * 7});
  // Two along the same rays.
  const auto both = sum_along_rays<RaySums<UnknownVoxels, UnknownVoxels>>(choice);
  EXPECT_EQ(both.front(), (std::array<double, 2>{63, 63}));
}

TEST(Utility, IsCastAtMostAtTheIdealResolution) {
  ViewToJudge view;
  view.resolution = {320, 40};
  view.ideal = {79, 59};
  EXPECT_EQ(ray_resolution(view), (Resolution{79, 40}));
}

TEST(Utility, MayLeaveOutViewsThatWereScanned) {
  const VoxelMap map = unseen_block();
  Utility utility = utility_by_name("combined");
  utility.skips_scanned_views = true;
  Planner planner(view_sphere(20, 2.5, Vec3::Zero()), camera, {}, utility);
  const View start = planner.candidates().views[0];
  const auto first = planner.next_best_view(map, start);
  ASSERT_TRUE(first);
  planner.scanned(first->best.view, first->best.candidate);
  const auto second = planner.next_best_view(map, start);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->best.candidate, first->ranking[1].candidate);
  ASSERT_EQ(second->infeasible.size(), 1U);
  EXPECT_EQ(second->infeasible.front().reason, "has been scanned from");
}

TEST(Utility, ThatComparesAllViewsRefusesTheMultiResolutionSearch) {
  Utility utility = utility_by_name("gua");
  utility.needs_all_views = true;
  PlannerOptions options;
  options.search = SearchKind::multi_resolution;
  EXPECT_THROW(Planner(view_sphere(20, 2.5, Vec3::Zero()), camera, options, utility), InputError);
}

TEST(Utility, GainMakesDoWithADeadline) {
  const VoxelMap map = unseen_block();
  PlannerOptions options;
  options.utility = "gain";
  options.deadline = 1e-6;
  Planner hurried(view_sphere(80, 2.5, Vec3::Zero()), camera, options);
  const auto some = hurried.next_best_view(map, hurried.candidates().views[0]);
  ASSERT_TRUE(some);
  EXPECT_EQ(some->feasible, 80U);
  EXPECT_LT(some->ranking.size(), 80U);
  EXPECT_EQ(some->explanation.find(concat("best of the ", some->ranking.size(), " of 80 views seen within")), 0U)
      << some->explanation;

  options.deadline = 60'000;
  Planner patient(view_sphere(80, 2.5, Vec3::Zero()), camera, options);
  const auto all = patient.next_best_view(map, patient.candidates().views[0]);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->ranking.size(), 80U);
  options.deadline = 0;
  Planner whole(view_sphere(80, 2.5, Vec3::Zero()), camera, options);
  EXPECT_EQ(all->best.candidate, whole.next_best_view(map, whole.candidates().views[0])->best.candidate);
}

TEST(Utility, GainIsExpectedUnderTheRobotsError) {
  const VoxelMap map = unseen_block();
  PlannerOptions options;
  options.utility = "gain";
  const auto best_with = [&](ErrorMethod method) {
    options.error_method = method;
    Planner planner(view_sphere(80, 2.5, Vec3::Zero()), camera, options);
    const auto plan = planner.next_best_view(map, planner.candidates().views[0]);
    EXPECT_TRUE(plan && plan->best.expected);
    return plan->best;
  };
  options.believed_error = std::make_shared<ConstantError>(PoseError::from_deviations({0.2, 0.2, 0.2}, Vec3::Zero()));
  for (const ErrorMethod method : {ErrorMethod::convolution, ErrorMethod::samples}) {
    const Evaluation best = best_with(method);
    EXPECT_GT(best.expected->utility, 0);
    // A pose near the best view is worth about what that is: the scale is that of all candidates.
    EXPECT_NEAR(best.expected->utility, best.utility, 0.3 * best.utility);
  }
}

TEST(Utility, MustGiveAFiniteNumberForEveryView) {
  const VoxelMap map = unseen_block();
  EXPECT_THROW(plan_with({.score = SetUtility([](const Choice&) { return std::vector<double>{1, 2}; })}, map), Error);
  const auto no_number = [](const Visibility&, const Factors&) { return std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_THROW(plan_with({.score = CountUtility(no_number)}, map), Error);
}

}  // namespace
}  // namespace vantage
