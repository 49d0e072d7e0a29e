#include "vantage/planning/planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

SceneOptions small_scene() {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(41);
  scene.enclosure_size = Index3::Constant(11);
  return scene;
}

/// Everything empty but one hidden voxel at the given place.
VoxelMap map_with_hidden_voxel(const Index3& hidden) {
  VoxelMap map(small_scene());
  const IndexBox box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) map.set_label({x, y, z}, Label::empty);
    }
  }
  map.set_label(hidden, Label::occluded);
  map.update_occplane();
  return map;
}

const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {80, 80});

TEST(Planner, ChoosesByOccplaneVoxelsWhereAllUtilitiesAreZero) {
  // A single occplane voxel and nothing else: x_op = 1, so that f_area = 0 everywhere.
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera);
  const VoxelMap map = map_with_hidden_voxel({20, 20, 20});
  const auto plan = planner.next_best_view(map, planner.candidates().views[3]);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->best.utility, 0);
  EXPECT_EQ(plan->best.seen.occplane, 1);
  EXPECT_EQ(plan->best.candidate, 0) << "ties fall to the lowest index";
}

TEST(Planner, FinishesWhenNoOccplaneVoxelIsMet) {
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera);
  VoxelMap map = map_with_hidden_voxel({20, 20, 20});
  map.set_label({20, 20, 20}, Label::empty);
  EXPECT_FALSE(planner.next_best_view(map, planner.candidates().views[0]));
  EXPECT_EQ(planner.why_finished(), "no feasible view meets an occplane voxel any more");
}

TEST(Planner, ToleratesSomeOccplaneVoxelsWhereAsked) {
  PlannerOptions options;
  options.stop_occplane = 1;
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera, options);
  EXPECT_FALSE(planner.next_best_view(map_with_hidden_voxel({20, 20, 20}), planner.candidates().views[0]));
  EXPECT_EQ(planner.why_finished(), "no feasible view meets more than 1 occplane voxels");
}

/// An occplane voxel at the bottom of a well of occupied voxels that opens along +z; all else is empty.
VoxelMap map_with_well() {
  VoxelMap map{SceneOptions{}};
  const Index3 bottom(102, 102, 110);
  for (int z = 75; z <= 129; ++z) {
    for (int y = 75; y <= 129; ++y) {
      for (int x = 75; x <= 129; ++x) {
        const Index3 from_bottom = Index3(x, y, z) - bottom;
        const bool on_axis = from_bottom.x() == 0 && from_bottom.y() == 0;
        const bool in_wall = from_bottom.head<2>().cwiseAbs().maxCoeff() <= 1 && from_bottom.z() >= -1 &&
                             from_bottom.z() <= 1 && !(on_axis && from_bottom.z() >= 0);
        map.set_label({x, y, z}, in_wall ? Label::occupied : Label::empty);
      }
    }
  }
  map.set_label(bottom, Label::occluded);
  map.update_occplane();
  return map;
}

TEST(Planner, MultiResolutionFindsTheSingleVoxelThatItsCoarseStagesMiss) {
  const VoxelMap map = map_with_well();
  const Candidates candidates = view_sphere(80, 2, Vec3::Zero());
  PlannerOptions options;
  options.search = SearchKind::multi_resolution;
  options.multi_resolution.min_columns = 2;  // four rays a view, all of which miss it
  Planner planner(candidates, camera_from_apertures(radians(45), radians(45), {320, 320}), options);
  // The coarse stage sees nothing, so that it keeps the first ten candidates: the premise is that these are blind.
  for (std::size_t i = 0; i < 10; ++i) {
    ASSERT_EQ(see_exactly(map, planner.camera(), candidates.views[i], {79, 79}).occplane, 0) << "candidate " << i;
  }
  const auto plan = planner.next_best_view(map, candidates.views[0]);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->ranking.size(), 80U) << "all views were asked again";
  EXPECT_GT(plan->ranking[0].utility + plan->ranking[0].seen.occplane, 0);
}

TEST(Planner, PlansTheNextInRankAfterAViewWasDiscarded) {
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera);
  const VoxelMap map(small_scene());
  const View& current = planner.candidates().views[0];
  VoxelMap with_hidden = map_with_hidden_voxel({20, 20, 20});
  const auto first = planner.next_best_view(with_hidden, current);
  ASSERT_TRUE(first);
  planner.discard(first->best.candidate, "a cable is in the way");
  const auto second = planner.next_best_view(with_hidden, current);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->best.candidate, first->ranking[1].candidate);
  ASSERT_EQ(second->infeasible.size(), 1U);
  EXPECT_EQ(second->infeasible[0].reason, "a cable is in the way");
}

TEST(Planner, ForgetsViewsSetAsideWhenTheMapChanges) {
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera);
  const VoxelMap map = map_with_hidden_voxel({20, 20, 20});
  planner.set_aside(0, "its scan could not be registered");
  EXPECT_EQ(planner.next_best_view(map, planner.candidates().views[5])->best.candidate, 1);
  planner.map_changed();
  EXPECT_EQ(planner.next_best_view(map, planner.candidates().views[5])->best.candidate, 0);
}

TEST(Planner, SaysWhyNoViewIsFeasible) {
  PlannerOptions options;
  options.reach.workspace = Box3(Vec3(10, 10, 10), Vec3(11, 11, 11));
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera, options);
  EXPECT_FALSE(planner.next_best_view(VoxelMap(small_scene()), view_towards({1, 2, 2}, Vec3::Zero())));
  EXPECT_EQ(planner.why_finished(), "none of the 20 candidate views is feasible (the first: outside the workspace)");
}

TEST(Planner, RanksByTheUtilityExpectedUnderPositioningError) {
  PlannerOptions options;
  const PositioningError error = PositioningError::from_deviations(Vec3::Constant(0.4));
  options.believed_error = std::make_shared<ConstantError>(error);
  Planner planner(view_cube(5, Vec3::Constant(4), 1.2, 3, Vec3::Zero()), camera, options);
  const VoxelMap map(small_scene());
  VoxelMap half = map_with_hidden_voxel({20, 20, 20});
  half.add_point({21, 20, 20}, Vec3::UnitX(), 1);
  const auto plan = planner.next_best_view(half, view_towards({2, 0, 0}, Vec3::Zero()));
  ASSERT_TRUE(plan);
  std::vector<double> utilities(planner.candidates().views.size(), 0.0);
  for (const Evaluation& each : plan->ranking) utilities[static_cast<std::size_t>(each.candidate)] = each.utility;
  const std::vector<double> expected = convolve(utilities, planner.candidates(), error);
  double best_utility = 0;
  for (const Evaluation& each : plan->ranking) {
    EXPECT_EQ(each.score, expected[static_cast<std::size_t>(each.candidate)]);
    EXPECT_LE(each.score, plan->best.score);
    best_utility = std::max(best_utility, each.utility);
  }
  EXPECT_GT(best_utility, 0);
  ASSERT_TRUE(plan->best.expected);
  EXPECT_NE(plan->explanation.find("overlap enough to be registered with probability"), std::string::npos)
      << plan->explanation;
}

TEST(Planner, RanksTheStrongestViewsByWhatIsSeenFromSampledPoses) {
  VoxelMap half = map_with_hidden_voxel({20, 20, 20});
  half.add_point({21, 20, 20}, Vec3::UnitX(), 1);
  for (const SearchKind search : {SearchKind::exhaustive, SearchKind::multi_resolution}) {
    PlannerOptions options;
    options.search = search;
    options.believed_error =
        std::make_shared<ConstantError>(PoseError::from_deviations(Vec3::Constant(0.3), Vec3::Constant(radians(5))));
    options.error_method = ErrorMethod::samples;
    options.expectation.candidates = 5;
    Planner planner(view_sphere(20, 2, Vec3::Zero()), camera, options);
    const auto plan = planner.next_best_view(half, planner.candidates().views[0]);
    ASSERT_TRUE(plan);
    ASSERT_EQ(plan->ranking.size(), 5U) << "views that were evaluated to the end";
    for (const Evaluation& each : plan->ranking) {
      ASSERT_TRUE(each.expected);
      EXPECT_EQ(each.expected->samples, 32);
      EXPECT_EQ(each.score, each.expected->utility);
      EXPECT_LE(each.score, plan->best.score);
    }
    // Told that the robot does not err, it goes by the utility.
    planner.believe({});
    EXPECT_EQ(planner.next_best_view(half, planner.candidates().views[0])->best.score,
              planner.next_best_view(half, planner.candidates().views[0])->best.utility);
  }
}

TEST(Planner, RefusesToConvolveWhatMultiResolutionLeavesOut) {
  PlannerOptions options;
  options.believed_error = std::make_shared<ConstantError>(PositioningError::from_deviations(Vec3::Constant(0.1)));
  options.search = SearchKind::multi_resolution;
  EXPECT_THROW(Planner(view_sphere(20, 2, Vec3::Zero()), camera, options), InputError);
}

TEST(Planner, MakesAPlanOfTheViewsThatItHadTimeFor) {
  PlannerOptions options;
  options.deadline = 1e-6;  // over before the first view
  const Candidates candidates = view_sphere(320, 2, Vec3::Zero());
  Planner planner(candidates, camera, options);
  const VoxelMap map(small_scene());  // all unmarked: without occplane voxels no view is of use
  EXPECT_FALSE(planner.next_best_view(map, candidates.views[0])) << "after all views were evaluated";
  EXPECT_EQ(planner.why_finished(), "no feasible view meets an occplane voxel any more");

  const auto plan = planner.next_best_view(map_with_hidden_voxel({20, 20, 20}), candidates.views[0]);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->feasible, 320U);
  EXPECT_LT(plan->ranking.size(), 320U);
  EXPECT_EQ(plan->best.seen.occplane, 1);
  EXPECT_EQ(plan->explanation.rfind(concat("best of the ", plan->ranking.size(), " of 320 views seen within "), 0), 0U)
      << plan->explanation;
}

TEST(Planner, PlansTheSameWithAndWithoutADeadlineThatIsFarOff) {
  PlannerOptions options;
  options.deadline = 1e18;
  const Candidates candidates = view_sphere(80, 2, Vec3::Zero());
  const VoxelMap map = map_with_well();
  const auto timed = Planner(candidates, camera, options).next_best_view(map, candidates.views[0]);
  const auto untimed = Planner(candidates, camera).next_best_view(map, candidates.views[0]);
  ASSERT_TRUE(timed && untimed);
  EXPECT_EQ(timed->best.candidate, untimed->best.candidate);
  EXPECT_EQ(timed->explanation, untimed->explanation);
  EXPECT_EQ(timed->ranking.size(), 80U);
}

TEST(Planner, RefusesADeadlineWhereViewsCannotBeLeftOut) {
  PlannerOptions options;
  options.deadline = 5;
  options.search = SearchKind::multi_resolution;
  EXPECT_THROW(options.validate(), InputError);
  options.search = SearchKind::exhaustive;
  EXPECT_NO_THROW(options.validate());
  options.believed_error = std::make_shared<ConstantError>(PositioningError::from_deviations(Vec3::Constant(0.1)));
  EXPECT_THROW(options.validate(), InputError);
  options.believed_error.reset();
  for (const double bad : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    options.deadline = bad;
    EXPECT_THROW(options.validate(), InputError);
  }
}

TEST(Planner, NamesUnknownUtilities) {
  EXPECT_THROW((void)utility_by_name("best"), InputError);
  PlannerOptions options;
  options.utility = "best";
  EXPECT_THROW(Planner(view_sphere(20, 2, Vec3::Zero()), camera, options), InputError);
}

}  // namespace
}  // namespace vantage
