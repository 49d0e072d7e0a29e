#include "vantage/utility/tour.hpp"

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/utility/met_voxels.hpp"

namespace vantage {
namespace {

/// What the views of a choice are expected to see: the voxels that their rays meet, at what those are worth.
TourProblem problem_of(const Choice& choice, MetVoxels met, const TourOptions& options) {
  TourProblem problem;
  const std::size_t views = met.of_view.size();
  std::vector<ClassCounts> counts(views);
  std::vector<double> worth(views);
  for (std::size_t i = 0; i < views; ++i) {
    counts[i] = met.counts(met.of_view[i], nullptr);
    worth[i] = met.worth(options.gain.worth, counts[i]);
  }
  problem.may_begin = overlapping(met, counts, worth, choice.refused, options.gain);
  problem.first_word.assign(met.first_word.begin(), met.first_word.end());
  problem.worth.assign(options.gain.worth.begin(), options.gain.worth.end());
  problem.known = static_cast<double>(choice.map.count(Label::occupied));
  problem.sees = std::move(met.of_view);
  const auto seconds = [&](const View& from, const View& to) {
    return options.time.seconds(choice.travel.distance(from.position(), to.position()));
  };
  for (const ViewToJudge& from : choice.views) {
    problem.first_seconds.push_back(seconds(choice.current, from.view));
    std::vector<double>& row = problem.seconds.emplace_back();
    for (const ViewToJudge& to : choice.views) row.push_back(seconds(from.view, to.view));
  }
  return problem;
}

std::vector<double> scores(const Choice& choice, const TourOptions& options) {
  MetVoxels met = meet(choice, options.gain);
  std::vector<double> result(choice.views.size(), 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (met.looked[i] == 0) result[i] = not_judged;
  }
  const TourProblem problem = problem_of(choice, std::move(met), options);
  for (const Tour& tour : good_tours(problem, options)) {
    result[static_cast<std::size_t>(tour.views.front())] = 1 / (1 + tour.cost);
  }
  return result;
}

}  // namespace

void TourOptions::validate() const {
  time.validate();
  gain.validate();
  require(left >= 0 && left < 1, "left = ", left, ": must be in [0, 1)");
  require(price > 0 && std::isfinite(price), "price = ", price, " s: must be positive");
  require(most_views >= 1 && most_views <= 100, "most-views = ", most_views, ": must be in 1..100");
  require(improved >= 0, "improved = ", improved, ": must not be negative");
  require(most_trials >= 0, "most-trials = ", most_trials, ": must not be negative");
}

Utility tour_utility(const TourOptions& options) {
  options.validate();
  return {.score = SetUtility([options](const Choice& choice) { return scores(choice, options); }),
          .needs_all_views = true,
          .skips_scanned_views = true,
          .tour = [options](const Choice& choice) { return best_tour(choice, options); }};
}

std::vector<TourStop> best_tour(const Choice& choice, const TourOptions& options) {
  const TourProblem problem = problem_of(choice, meet(choice, options.gain), options);
  const std::vector<Tour> tours = good_tours(problem, options);
  std::vector<TourStop> stops;
  if (tours.empty()) return stops;
  const double whole = problem.known + tour_along(problem, options, {}).left;
  std::vector<int> views;
  for (const int view : tours.front().views) {
    views.push_back(view);
    const Tour until = tour_along(problem, options, views);
    stops.push_back({choice.views[static_cast<std::size_t>(view)].candidate, until.seconds, 1 - until.left / whole});
  }
  return stops;
}

}  // namespace vantage
