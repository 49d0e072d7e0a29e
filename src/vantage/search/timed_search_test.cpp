#include "vantage/search/timed_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "vantage/search/view_queue.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<int> first_candidates(int count) {
  std::vector<int> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// Everything empty but a slab of hidden voxels that is closed by occupied ones on all sides but +x.
VoxelMap map_with_box_open_to_x() {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(41);
  scene.enclosure_size = Index3::Constant(11);
  VoxelMap map(scene);
  const IndexBox box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Index3 from_center = Index3(x, y, z) - Index3::Constant(20);
        const bool is_inside = from_center.cwiseAbs().maxCoeff() <= 3;
        const bool is_wall = is_inside && (from_center.tail<2>().cwiseAbs().maxCoeff() == 3 || from_center.x() == -3);
        map.set_label({x, y, z}, !is_inside ? Label::empty : is_wall ? Label::occupied : Label::occluded);
      }
    }
  }
  map.update_occplane();
  return map;
}

struct TimedSearch : public ::testing::Test {
  VoxelMap map = map_with_box_open_to_x();
  VisibilityEvaluator visibility{map};
  RangeCamera camera = camera_from_apertures(radians(45), radians(45), {64, 64});
  Candidates candidates = view_sphere(320, 2, Vec3::Zero());
  ViewEvaluation problem{
      map,
      visibility,
      camera,
      candidates,
      map.grid().length,
      {Travel::Path::orthodromic, Vec3::Zero(), 2},
      candidates.views[0],
      {},
      {.score = CountUtility([](const Visibility&, const Factors& f) { return combined_utility(f); })}};
  std::vector<int> all = first_candidates(320);
};

TEST_F(TimedSearch, IsTheExhaustiveSearchWhereThereIsTime) {
  const auto timed = search_until({Clock::now() + std::chrono::hours(1)}, problem, all, {});
  const auto exhaustive = exhaustive_search(problem, all, {});
  ASSERT_EQ(timed.size(), exhaustive.size());
  for (std::size_t i = 0; i < timed.size(); ++i) {
    EXPECT_EQ(timed[i].candidate, exhaustive[i].candidate);
    EXPECT_EQ(timed[i].seen, exhaustive[i].seen);
    EXPECT_EQ(timed[i].utility, exhaustive[i].utility);
  }
}

TEST_F(TimedSearch, LeavesViewsOutPastTheDeadlineAndCountsTheOthersWhole) {
  const auto timed = search_until({Clock::now() - std::chrono::seconds(1)}, problem, all, {});
  EXPECT_GE(timed.size(), 1U) << "a plan needs a view";
  EXPECT_LT(timed.size(), all.size() / 2);
  for (const Evaluation& each : timed) EXPECT_EQ(each.seen, see_exactly(map, camera, each.view, each.resolution));
}

TEST_F(TimedSearch, GoesOnPastTheDeadlineUntilAViewIsOfUse) {
  // Just one candidate looks into the box, and it comes last of all: the others are those from behind.
  std::vector<int> behind;
  int in_front = -1;
  for (const int i : all) {
    const Vec3 position = candidates.views[static_cast<std::size_t>(i)].position();
    if (position.x() < -0.2) behind.push_back(i);
    if (position.x() > 1.9) in_front = i;
  }
  ASSERT_GE(in_front, 0);
  ASSERT_GT(behind.size(), 100U);
  std::vector<int> feasible = behind;
  feasible.push_back(in_front);
  const TimeBox past{Clock::now() - std::chrono::seconds(1)};
  const auto found = search_until(past, problem, feasible, {});
  EXPECT_EQ(found.front().candidate, in_front);
  EXPECT_GT(found.front().seen.occplane, 0);
  EXPECT_EQ(search_until(past, problem, behind, {}).size(), behind.size())
      << "all of them, before anyone concludes that nothing is left";
}

/// Scores views by their share of the most occplane voxels; late for all but the first `in_time` of them.
Utility comparing(int& asked, std::size_t in_time) {
  const auto score = [&asked, in_time](const Choice& choice) {
    ++asked;
    int most = 1;
    for (const ViewToJudge& view : choice.views) most = std::max(most, view.seen.occplane);
    std::vector<double> scores;
    for (const ViewToJudge& view : choice.views) {
      const bool is_late = choice.deadline && scores.size() >= in_time;
      scores.push_back(is_late ? not_judged : static_cast<double>(view.seen.occplane) / most);
    }
    return scores;
  };
  return {.score = SetUtility(score), .needs_all_views = true};
}

TEST_F(TimedSearch, AsksAUtilityThatComparesViewsAboutAllOfThemAtOnce) {
  int asked = 0;
  problem.utility = comparing(asked, 320);
  const auto exhaustive = exhaustive_search(problem, all, {});
  asked = 0;
  const auto timed = search_until({Clock::now() + std::chrono::hours(1)}, problem, all, {});
  EXPECT_EQ(asked, 1);
  ASSERT_EQ(timed.size(), exhaustive.size());
  for (std::size_t i = 0; i < timed.size(); ++i) {
    EXPECT_EQ(timed[i].candidate, exhaustive[i].candidate);
    EXPECT_EQ(timed[i].score, exhaustive[i].score);
  }
}

TEST_F(TimedSearch, RanksOnlyWhatAUtilityThatComparesViewsHadTimeFor) {
  int asked = 0;
  problem.utility = comparing(asked, 5);
  const auto some = search_until({Clock::now() + std::chrono::hours(1)}, problem, all, {});
  EXPECT_EQ(some.size(), 5U);
  // The five that see most: those are asked about first.
  const auto exhaustive = exhaustive_search(problem, all, {});
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i].seen.occplane, exhaustive[i].seen.occplane);

  problem.utility = comparing(asked, 0);
  const auto late = search_until({Clock::now() - std::chrono::seconds(1)}, problem, all, {});
  EXPECT_LT(late.size(), all.size() / 2);
  EXPECT_TRUE(std::any_of(late.begin(), late.end(), [](const Evaluation& each) { return each.seen.occplane > 0; }))
      << "goes on until a view is of use";
}

TEST(ViewQueue, GivesEveryCandidateOnce) {
  const Candidates candidates = view_cube(7, Vec3::Constant(4), 0.8, 1.9, Vec3::Zero());
  const std::vector<int> feasible = first_candidates(static_cast<int>(candidates.views.size()) - 3);
  ViewQueue queue(candidates, feasible);
  std::vector<int> given;
  while (!queue.empty()) {
    for (const int candidate : queue.next(10)) {
      given.push_back(candidate);
      Evaluation evaluation;
      evaluation.candidate = candidate;
      evaluation.score = candidate % 17;
      queue.learn({&evaluation, 1});
    }
  }
  EXPECT_THAT(given, ::testing::UnorderedElementsAreArray(feasible));
}

TEST(ViewQueue, BeginsWithViewsAllAround) {
  const Candidates candidates = view_sphere(320, 2, Vec3::Zero());
  ViewQueue queue(candidates, first_candidates(320));
  const std::vector<int> first = queue.next(32);
  ASSERT_EQ(first.size(), 32U);
  double farthest = 0;  // of any candidate from those
  for (const View& view : candidates.views) {
    double nearest = 10;
    for (const int i : first) {
      nearest = std::min(
          nearest, std::acos(std::min(1.0, view.axis().dot(candidates.views[static_cast<std::size_t>(i)].axis()))));
    }
    farthest = std::max(farthest, nearest);
  }
  // 32 caps of 20.4 degrees have the area of the sphere; no cover is that good, twice that is easy.
  EXPECT_LT(degrees(farthest), 40.8);
}

/// A view that lies 90 degrees from the sought direction or farther scores 0, with two hills in between.
double score(const Vec3& axis) {
  return std::max(0.0, axis.dot(Vec3(0.6, 0, 0.8))) + 0.7 * std::max(0.0, axis.dot(Vec3(0, -0.8, -0.6)));
}

TEST(ViewQueue, FindsTheBestViewOfASmoothScoreInTheFirstQuarter) {
  const Candidates candidates = view_sphere(1280, 2, Vec3::Zero());
  double best = 0;
  for (const View& view : candidates.views) best = std::max(best, score(view.axis()));
  ViewQueue queue(candidates, first_candidates(1280));
  double found = 0;
  for (int round = 0; round < 2; ++round) {
    std::vector<Evaluation> evaluations;
    for (const int candidate : queue.next(160)) {
      evaluations.emplace_back().candidate = candidate;
      evaluations.back().score = score(candidates.views[static_cast<std::size_t>(candidate)].axis());
      found = std::max(found, evaluations.back().score);
    }
    queue.learn(evaluations);
  }
  EXPECT_EQ(found, best);
}

}  // namespace
}  // namespace vantage
