#include "vantage/search/search.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(MultiResolution, HasThePapersNumberOfStages) {
  EXPECT_EQ(number_of_stages(80, 10), 2);
  EXPECT_EQ(number_of_stages(320, 10), 3);
  EXPECT_EQ(number_of_stages(1280, 10), 4);
  EXPECT_EQ(number_of_stages(100, 10), 2);
  EXPECT_EQ(number_of_stages(10, 10), 1);
  EXPECT_EQ(number_of_stages(1, 10), 1);
}

TEST(MultiResolution, RaisesTheResolutionInEqualSteps) {
  EXPECT_EQ(stage_resolution({79, 79}, 40, 1, 2), (Resolution{40, 40}));
  EXPECT_EQ(stage_resolution({79, 79}, 40, 2, 2), (Resolution{79, 79}));
  // Three stages: 79 - 1 * (79 - 40) / 2 = 59.5, to the nearest.
  EXPECT_EQ(stage_resolution({79, 79}, 40, 2, 3), (Resolution{60, 60}));
  // Rows follow the aspect of the ideal resolution: 40 * 60 / 80 = 30.
  EXPECT_EQ(stage_resolution({80, 60}, 40, 1, 2), (Resolution{40, 30}));
  EXPECT_EQ(stage_resolution({20, 10}, 40, 1, 2), (Resolution{20, 10})) << "never above the ideal";
  EXPECT_EQ(stage_resolution({79, 79}, 40, 1, 1), (Resolution{79, 79}));
}

Evaluation evaluation(int candidate, double utility, int occplane) {
  Evaluation result;
  result.candidate = candidate;
  result.score = utility;
  result.seen.occplane = occplane;
  return result;
}

std::vector<int> order(std::vector<Evaluation> evaluations) {
  rank(evaluations);
  std::vector<int> candidates;
  for (const Evaluation& each : evaluations) candidates.push_back(each.candidate);
  return candidates;
}

TEST(Rank, PutsTheHighestUtilityFirstAndBreaksTiesByIndex) {
  EXPECT_EQ(order({evaluation(3, 0.5, 0), evaluation(1, 0.5, 9), evaluation(2, 0.7, 1), evaluation(0, 0, 99)}),
            (std::vector<int>{2, 1, 3, 0}));
}

TEST(Rank, FallsBackToOccplaneVoxelsWhereNoUtilityIsPositive) {
  EXPECT_EQ(order({evaluation(3, 0, 5), evaluation(1, 0, 9), evaluation(2, 0, 5)}), (std::vector<int>{1, 2, 3}));
}

/// A map with a shell of occupied voxels seen from one side and hidden ones behind it.
VoxelMap half_seen_ball() {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(41);
  scene.enclosure_size = Index3::Constant(13);
  VoxelMap map(scene);
  for (int z = map.enclosure().min.z(); z <= map.enclosure().max.z(); ++z) {
    for (int y = map.enclosure().min.y(); y <= map.enclosure().max.y(); ++y) {
      for (int x = map.enclosure().min.x(); x <= map.enclosure().max.x(); ++x) {
        const Vec3 p = map.grid().center({x, y, z});
        if (p.norm() > 0.45) map.set_label({x, y, z}, p.x() > 0 ? Label::empty : Label::occluded);
        if (p.norm() <= 0.45 && p.norm() > 0.33 && p.x() > 0) map.add_point({x, y, z}, p.normalized(), 0.8);
      }
    }
  }
  map.update_occplane();
  return map;
}

struct SearchOnHalfBall : public ::testing::Test {
  VoxelMap map = half_seen_ball();
  VisibilityEvaluator visibility{map};
  RangeCamera camera = camera_from_apertures(radians(45), radians(45), {64, 64});
  Candidates candidates = view_sphere(80, 2, Vec3::Zero());
  Utility utility{.score = CountUtility([](const Visibility&, const Factors& f) { return combined_utility(f); })};
  ViewEvaluation problem{map,
                         visibility,
                         camera,
                         candidates,
                         map.grid().length,
                         {Travel::Path::orthodromic, Vec3::Zero(), 2},
                         candidates.views[0],
                         {},
                         utility};
  std::vector<int> all = [] {
    std::vector<int> indices(80);
    for (int i = 0; i < 80; ++i) indices[static_cast<std::size_t>(i)] = i;
    return indices;
  }();
};

TEST_F(SearchOnHalfBall, ExhaustiveSearchEvaluatesEveryViewAsTheReferenceDoes) {
  const std::vector<Evaluation> ranking = exhaustive_search(problem, all, {});
  ASSERT_EQ(ranking.size(), 80U);
  int with_occplane = 0;
  for (const Evaluation& each : ranking) {
    const View& view = candidates.views[static_cast<std::size_t>(each.candidate)];
    EXPECT_EQ(each.seen, see_exactly(map, camera, view, {64, 64}));
    with_occplane += each.seen.occplane > 0 ? 1 : 0;
  }
  EXPECT_GT(with_occplane, 20);
  for (std::size_t i = 1; i < ranking.size(); ++i) EXPECT_GE(ranking[i - 1].utility, ranking[i].utility);
}

TEST_F(SearchOnHalfBall, MultiResolutionEndsWithTheBestOfTenAtTheIdealResolution) {
  const std::vector<Evaluation> ranking = multi_resolution_search(problem, all, {});
  ASSERT_EQ(ranking.size(), 10U);
  for (const Evaluation& each : ranking) EXPECT_EQ(each.resolution, problem.ideal(each.candidate));
  const std::vector<Evaluation> exhaustive = exhaustive_search(problem, all, {RayChoice::Kind::ideal, {}});
  // On so smooth a scene the coarse stage keeps the best view.
  EXPECT_EQ(ranking.front().candidate, exhaustive.front().candidate);
}

TEST(MultiResolutionOptions, NameTheBadValue) {
  MultiResolutionOptions options;
  options.b = 1;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.stages = 0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vantage
