#include "vantage/utility/tour.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "support/random_scenes.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// Pieces of two classes, some views that see some of them, and times that are no metric.
TourProblem random_problem(Random& random, int views) {
  TourProblem problem;
  problem.first_word = {0, 1, 3};
  problem.worth = {1, 0.4};
  problem.known = 20;
  for (int v = 0; v < views; ++v) {
    std::vector<std::uint64_t> sees(3, 0);
    for (std::size_t piece = 0; piece < 160; ++piece) {
      if (random.uniform() < 0.3) sees[piece / 64] |= std::uint64_t{1} << (piece % 64);
    }
    problem.sees.push_back(sees);
    problem.first_seconds.push_back(random.uniform(3, 15));
    problem.may_begin.push_back(random.uniform() < 0.7 ? 1 : 0);
    std::vector<double>& row = problem.seconds.emplace_back();
    for (int to = 0; to < views; ++to) row.push_back(random.uniform(3, 15));
  }
  problem.may_begin[0] = 1;
  return problem;
}

using Pieces = std::set<std::size_t>;

Pieces pieces_of(const std::vector<std::uint64_t>& bits) {
  Pieces pieces;
  for (std::size_t piece = 0; piece < 64 * bits.size(); ++piece) {
    if ((bits[piece / 64] >> (piece % 64) & 1U) != 0) pieces.insert(piece);
  }
  return pieces;
}

double worth_naively(const Pieces& pieces) {
  double sum = 0;
  for (const std::size_t piece : pieces) sum += piece < 64 ? 1 : 0.4;
  return sum;
}

/// The definition, with sets.
double cost_naively(const TourProblem& problem, const TourOptions& options, const std::vector<int>& views) {
  Pieces all, seen;
  for (const auto& bits : problem.sees) all.merge(pieces_of(bits));
  double seconds = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto to = static_cast<std::size_t>(views[i]);
    seconds += i == 0 ? problem.first_seconds[to] : problem.seconds[static_cast<std::size_t>(views[i - 1])][to];
    seen.merge(pieces_of(problem.sees[to]));
  }
  const double left = worth_naively(all) - worth_naively(seen);
  return seconds + options.price * std::max(0.0, left / (problem.known + worth_naively(all)) - options.left);
}

/// The cheapest of all orders of at most `most` views.
double least_cost(const TourProblem& problem, const TourOptions& options, std::vector<int> views, int most) {
  double least = views.empty() ? 1e300 : cost_naively(problem, options, views);
  if (static_cast<int>(views.size()) == most) return least;
  for (int next = 0; next < static_cast<int>(problem.sees.size()); ++next) {
    if (std::find(views.begin(), views.end(), next) != views.end()) continue;
    if (views.empty() && problem.may_begin[static_cast<std::size_t>(next)] == 0) continue;
    std::vector<int> longer = views;
    longer.push_back(next);
    least = std::min(least, least_cost(problem, options, longer, most));
  }
  return least;
}

TEST(Tour, CostsWhatItsDefinitionSaysOnRandomProblems) {
  Random random(11);
  int compared = 0;
  for (int round = 0; round < 200; ++round) {
    const TourProblem problem = random_problem(random, 8);
    TourOptions options;
    options.left = random.uniform(0, 0.1);
    options.price = random.uniform(10, 1000);
    std::vector<int> views;
    for (int length = random.index(6); length >= 0; --length) views.push_back(random.index(8));
    EXPECT_NEAR(tour_along(problem, options, views).cost, cost_naively(problem, options, views), 1e-9);
    ++compared;
  }
  EXPECT_EQ(compared, 200);
}

TEST(Tour, IsMostlyTheBestOfAllOrders) {
  Random random(12);
  int optimal = 0;
  double excess = 0;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    const TourProblem problem = random_problem(random, 6);
    TourOptions options;
    options.most_views = 4;
    options.price = 100;
    const std::vector<Tour> tours = good_tours(problem, options);
    const double least = least_cost(problem, options, {}, options.most_views);
    const double found = tours.front().cost;
    EXPECT_NEAR(found, cost_naively(problem, options, tours.front().views), 1e-9);
    EXPECT_GE(found, least - 1e-9) << "no tour can be better than all orders";
    optimal += found < least + 1e-9 ? 1 : 0;
    excess += found / least - 1;
  }
  EXPECT_GE(optimal, rounds * 8 / 10);
  EXPECT_LT(excess / rounds, 0.02);
}

TEST(Tour, BeginsOnlyWhereItMayAndRanksEachFirstViewOnce) {
  Random random(13);
  int begun = 0;
  for (int round = 0; round < 50; ++round) {
    const TourProblem problem = random_problem(random, 10);
    const std::vector<Tour> tours = good_tours(problem, {});
    const auto allowed = std::count(problem.may_begin.begin(), problem.may_begin.end(), 1);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(tours.size()), allowed);
    std::set<int> firsts;
    for (const Tour& tour : tours) {
      EXPECT_EQ(problem.may_begin[static_cast<std::size_t>(tour.views.front())], 1);
      firsts.insert(tour.views.front());
      ++begun;
    }
    EXPECT_EQ(firsts.size(), tours.size());
    EXPECT_TRUE(
        std::is_sorted(tours.begin(), tours.end(), [](const Tour& a, const Tour& b) { return a.cost < b.cost; }));
  }
  EXPECT_GT(begun, 200);
}

/// Views around a map of random scans, as a planner asks about them.
struct AskedViews {
  explicit AskedViews(Random& random) : map(test::random_map(random, test::MapKind::scans)) {
    for (int i = 0; i < 12; ++i) {
      ViewToJudge view;
      view.candidate = 10 + i;
      view.view = test::random_view(map, random, test::Stand::outside);
      view.ideal = {20, 20};
      views.push_back(view);
    }
  }
  [[nodiscard]] Choice choice() const { return {map, visibility, camera, views[0].view, {}, 1, views}; }

  VoxelMap map;
  VisibilityEvaluator visibility{map};
  RangeCamera camera = camera_from_apertures(radians(50), radians(40), {64, 64});
  std::vector<ViewToJudge> views;
};

TEST(Tour, IsTheSameForAnyNumberOfThreads) {
  Random random(14);
  int positive = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const AskedViews asked(random);
    std::vector<std::vector<double>> scores;
    for (const std::size_t threads : {1U, 4U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      scores.push_back(judge(tour_utility(), asked.choice()));
    }
    EXPECT_EQ(scores[0], scores[1]);
    positive += *std::max_element(scores[0].begin(), scores[0].end()) > 0 ? 1 : 0;
  }
  EXPECT_GE(positive, 5);
}

TEST(Tour, SaysItsStopsWithTheFirstViewOfTheHighestScore) {
  Random random(15);
  int stops = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const AskedViews asked(random);
    const std::vector<double> scores = judge(tour_utility(), asked.choice());
    const std::vector<TourStop> tour = best_tour(asked.choice());
    if (tour.empty()) continue;
    const auto best = std::max_element(scores.begin(), scores.end()) - scores.begin();
    EXPECT_EQ(tour.front().candidate, 10 + best);
    double seconds = 0, covered = 0;
    for (const TourStop& stop : tour) {
      EXPECT_GE(stop.seconds, seconds + 3) << "each scan takes three seconds";
      EXPECT_GE(stop.covered, covered);
      EXPECT_LE(stop.covered, 1);
      seconds = stop.seconds;
      covered = stop.covered;
      ++stops;
    }
  }
  EXPECT_GE(stops, 10);
}

TEST(Tour, NamesBadOptions) {
  const auto refuses = [](const auto& change) {
    TourOptions options;
    change(options);
    EXPECT_THROW((void)tour_utility(options), InputError);
  };
  refuses([](TourOptions& o) { o.left = 1; });
  refuses([](TourOptions& o) { o.price = 0; });
  refuses([](TourOptions& o) { o.most_views = 0; });
  refuses([](TourOptions& o) { o.time.speed = 0; });
  refuses([](TourOptions& o) { o.gain.floor_step = 1; });
}

}  // namespace
}  // namespace vantage
