#include "vantage/experiments/known_object.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "vantage/simulation/objects.hpp"

namespace vantage {
namespace {

TEST(SmallestCover, FindsByExchangeWhatGreedyChoiceMisses) {
  KnownScans scans;
  scans.voxels.assign(8, Index3::Zero());
  scans.area.assign(8, 0.125);
  // The start sees nothing; the largest set lies across the two halves that would do.
  scans.of_view = {{0b00000000}, {0b01101110}, {0b00001111}, {0b11110000}};
  EXPECT_DOUBLE_EQ(scans.covered({0b01101110}), 5.0 / 8);
  std::vector<int> views = smallest_cover(scans, 0, 0.99);
  ASSERT_EQ(views.size(), 3U);
  EXPECT_EQ(views.front(), 0);
  std::sort(views.begin(), views.end());
  EXPECT_EQ(views, (std::vector<int>{0, 2, 3}));
}

TEST(KnownObject, PlansAsItsKnowledgeSays) {
  ReconstructOptions options;
  options.camera = "45x45:80x80";
  options.candidates = "sphere:20:2";
  options.max_views = 12;
  const SimulatedObject object(make_object("sphere"), 0.815, options);
  const KnownScans scans = known_scans(object, options);
  EXPECT_EQ(scans.of_view.size(), 20U);
  EXPECT_NEAR(std::accumulate(scans.area.begin(), scans.area.end(), 0.0), 1, 1e-9);
  const auto views_to_cover = [&](const Utility& utility) {
    const SimulatedRun run = simulate(object, options, {}, utility);
    const auto& done = run.model.scans;
    const auto reached =
        std::find_if(done.begin(), done.end(), [](const ScanRecord& r) { return *r.coverage >= 0.95; });
    return reached - done.begin() + 1;
  };
  const std::vector<int> cover = smallest_cover(scans, options.initial_view, 0.95);
  const auto greedy = views_to_cover(known_greedy_utility(object, options));
  const auto optimum = views_to_cover(known_optimum_utility(object, options, 0.95));
  EXPECT_LE(optimum, greedy);
  EXPECT_LE(greedy, 10);
  EXPECT_NEAR(static_cast<double>(optimum), static_cast<double>(cover.size()), 1) << "what the cover says";
}

}  // namespace
}  // namespace vantage
