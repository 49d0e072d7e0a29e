#include "vantage/utility/gain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "support/random_scenes.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// Steps through unknown voxels to the nearest occupied one, by breadth-first search; -1: none.
std::map<std::array<int, 3>, int> steps_to_occupied(const VoxelMap& map) {
  std::map<std::array<int, 3>, int> steps;
  std::vector<Index3> front = map.occupied_voxels();
  for (int step = 1; !front.empty(); ++step) {
    std::vector<Index3> next;
    for (const Index3& voxel : front) {
      for (int side = 0; side < 6; ++side) {
        Index3 at = voxel;
        at[side / 2] += side % 2 == 0 ? 1 : -1;
        const Label label = map.label(at);
        if (label == Label::empty || label == Label::occupied) continue;
        if (steps.emplace(std::array{at.x(), at.y(), at.z()}, step).second) next.push_back(at);
      }
    }
    front = next;
  }
  return steps;
}

std::size_t class_of(const std::map<std::array<int, 3>, int>& steps, const std::array<int, 3>& voxel) {
  const auto found = steps.find(voxel);
  if (found == steps.end() || found->second > 7) return 3;
  return found->second <= 1 ? 0 : found->second <= 3 ? 1 : 2;
}

/// The definition, with sets of voxels from exact rays.
std::vector<double> gain_naively(const Choice& choice, const GainOptions& options) {
  const auto steps = steps_to_occupied(choice.map);
  using Set = std::set<std::array<int, 3>>;
  const auto worth = [&](const Set& set) {
    std::array<int, 4> counts{};
    for (const std::array<int, 3>& voxel : set) ++counts[class_of(steps, voxel)];
    double sum = 0;
    for (std::size_t c = 0; c < counts.size(); ++c) sum += options.worth[c] * counts[c];
    return sum;
  };
  std::vector<Set> sets;
  std::vector<double> worths, overlaps;
  Set all;
  for (const ViewToJudge& view : choice.views) {
    const auto times = [&](int rays) { return static_cast<int>(std::lround(rays * options.rays_per_ideal)); };
    const Sight sight = see_past_grazing_exactly(choice.map, choice.camera, view.view,
                                                 {times(view.ideal.columns), times(view.ideal.rows)}, options.grazing);
    Set set;
    for (const Index3& voxel : sight.unknown) set.insert({voxel.x(), voxel.y(), voxel.z()});
    all.insert(set.begin(), set.end());
    worths.push_back(worth(set));
    const auto occupied = static_cast<double>(sight.occupied.size());
    overlaps.push_back(
        occupied + static_cast<double>(set.size()) > 0 ? occupied / (occupied + static_cast<double>(set.size())) : 0);
    sets.push_back(std::move(set));
  }
  const double whole = worth(all);
  std::vector<double> scores(sets.size(), 0.0);
  double floor = std::max(options.min_overlap,
                          std::min(options.highest_floor, options.min_overlap * std::pow(2.0, choice.refused)));
  std::vector<std::size_t> allowed;
  while (whole > 0 && allowed.empty()) {
    for (std::size_t v = 0; v < sets.size(); ++v) {
      if (worths[v] > 0 && overlaps[v] >= floor) allowed.push_back(v);
    }
    floor = floor > 1e-3 ? floor * options.floor_step : 0;
  }
  const double best = *std::max_element(worths.begin(), worths.end());
  const bool is_last =
      whole - best <= options.last_view_share * (whole + static_cast<double>(choice.map.count(Label::occupied)));
  for (const std::size_t v : allowed) {
    double next = 0;
    for (std::size_t u = 0; u < sets.size() && !is_last; ++u) {
      Set rest;
      std::set_difference(sets[u].begin(), sets[u].end(), sets[v].begin(), sets[v].end(),
                          std::inserter(rest, rest.end()));
      next = std::max(next, worth(rest));
    }
    scores[v] = (worths[v] + options.lookahead * next) / whole + options.travel * (1 - choice.views[v].travel);
  }
  return scores;
}

TEST(Gain, GivesWhatItsDefinitionGivesOnRandomScenes) {
  Random random(41);
  int compared = 0;
  int positive = 0;
  for (int scene = 0; scene < 60; ++scene) {
    const VoxelMap map =
        test::random_map(random, test::one_of<test::MapKind>(random, {test::MapKind::blobs, test::MapKind::scans}));
    const VisibilityEvaluator visibility(map);
    const RangeCamera camera = camera_from_apertures(radians(50), radians(40), {64, 64});
    std::vector<ViewToJudge> views;
    for (int i = 0; i < 12; ++i) {
      ViewToJudge view;
      view.candidate = i;
      view.view = test::random_view(map, random, test::Stand::outside);
      view.ideal = {9 + random.index(20), 9 + random.index(20)};
      view.travel = random.uniform();
      views.push_back(view);
    }
    Choice choice{map, visibility, camera, views[0].view, {}, 1, views};
    choice.refused = random.index(4);
    GainOptions options;
    options.min_overlap = random.uniform() < 0.5 ? random.uniform(0, 0.2) : random.uniform(0, 0.9);
    options.last_view_share = random.uniform() < 0.5 ? 0.01 : 0.2;
    const std::vector<double> expected = gain_naively(choice, options);
    const std::vector<double> scores = judge(gain_utility(options), choice);
    for (std::size_t i = 0; i < views.size(); ++i) {
      ASSERT_EQ(scores[i], expected[i]) << "scene " << scene << ", view " << i;
      ++compared;
      positive += scores[i] > 0;
    }
  }
  EXPECT_EQ(compared, 60 * 12);
  EXPECT_GT(positive, 100);
}

/// Few voxels of each kind in an enclosure that is longer along one axis than ten bits count.
VoxelMap long_map(int axis, Random& random) {
  Index3 size = Index3::Constant(7);
  size[axis] = 1100;
  const Grid grid{Vec3::Zero(), 0.02, size};
  VoxelMap map(grid, grid.all());
  for (int z = 0; z < size.z(); ++z) {
    for (int y = 0; y < size.y(); ++y) {
      for (int x = 0; x < size.x(); ++x) {
        const int kind = random.index(20);
        if (kind < 12) map.set_label({x, y, z}, Label::empty);
        if (kind == 12 || kind == 13) map.set_label({x, y, z}, Label::occluded);
        if (kind == 14) (void)map.add_point({x, y, z}, random.unit_vector(), 0.5);
      }
    }
  }
  map.update_occplane();
  return map;
}

TEST(Gain, GivesWhatItsDefinitionGivesInEnclosuresBeyondTenBits) {
  Random random(47);
  int compared = 0, positive = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelMap map = long_map(axis, random);
    const VisibilityEvaluator visibility(map);
    const RangeCamera camera = camera_from_apertures(radians(50), radians(40), {64, 64});
    std::vector<ViewToJudge> views;
    for (int i = 0; i < 8; ++i) {
      // Beside both ends: the voxels there differ in the bits beyond the tenth alone.
      Vec3 target = Vec3::Constant(0.07);
      target[axis] = 0.02 * (i % 2 == 0 ? 1060 : 36);
      Vec3 position = target + 0.6 * random.unit_vector();
      ViewToJudge view;
      view.candidate = i;
      view.view = view_towards(position, target);
      view.ideal = {20, 20};
      view.travel = random.uniform();
      views.push_back(view);
    }
    const Choice choice{map, visibility, camera, views[0].view, {}, 1, views};
    const std::vector<double> expected = gain_naively(choice, {});
    const std::vector<double> scores = judge(gain_utility(), choice);
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_EQ(scores[i], expected[i]) << "axis " << axis << ", view " << i;
      ++compared;
      positive += scores[i] > 0;
    }
  }
  EXPECT_EQ(compared, 24);
  EXPECT_GE(positive, 6);  // only the strongest views of a choice have a score above zero
}

TEST(Gain, CountsStepsThroughUnknownVoxelsOnly) {
  // Occupied, five unknown, an empty one, two unknown behind it; all around empty.
  const Grid grid{Vec3::Zero(), 1.0, Index3(9, 1, 1)};
  VoxelMap map(grid, {Index3::Zero(), Index3(8, 0, 0)});
  map.set_label({0, 0, 0}, Label::occupied);
  map.set_label({6, 0, 0}, Label::empty);
  const auto near = unknown_near_occupied(map);
  EXPECT_EQ(near[0].words[0], 0b000000010U);
  EXPECT_EQ(near[1].words[0], 0b000001110U);
  EXPECT_EQ(near[2].words[0], 0b000111110U) << "the two behind the empty voxel are not reached";
}

TEST(Gain, JudgesNoViewAfterTheDeadline) {
  Random random(43);
  const VoxelMap map = test::random_map(random, test::MapKind::scans);
  const VisibilityEvaluator visibility(map);
  const RangeCamera camera = camera_from_apertures(radians(50), radians(40), {64, 64});
  std::vector<ViewToJudge> views(3);
  for (ViewToJudge& view : views) {
    view.view = test::random_view(map, random, test::Stand::outside);
    view.ideal = {20, 20};
  }
  Choice choice{map, visibility, camera, views[0].view, {}, 1, views};
  choice.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
  EXPECT_EQ(judge(gain_utility(), choice), std::vector<double>(3, not_judged));
  choice.deadline = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const std::vector<double> in_time = judge(gain_utility(), choice);
  choice.deadline.reset();
  EXPECT_EQ(in_time, judge(gain_utility(), choice));
}

TEST(Gain, NamesBadOptions) {
  GainOptions options;
  options.floor_step = 1;
  EXPECT_THROW((void)gain_utility(options), InputError);
  options = {};
  options.worth[2] = -1;
  EXPECT_THROW((void)gain_utility(options), InputError);
}

}  // namespace
}  // namespace vantage
