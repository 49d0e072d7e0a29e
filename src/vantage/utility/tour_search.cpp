#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "vantage/core/parallel.hpp"
#include "vantage/utility/tour.hpp"

namespace vantage {
namespace {

using Bits = std::vector<std::uint64_t>;

double worth_of_new(const TourProblem& problem, const Bits& seen, const Bits& held) {
  double sum = 0;
  for (std::size_t c = 0; c < problem.worth.size(); ++c) {
    std::int64_t pieces = 0;
    for (std::size_t w = problem.first_word[c]; w < problem.first_word[c + 1]; ++w) {
      pieces += std::popcount(seen[w] & ~held[w]);
    }
    sum += problem.worth[c] * static_cast<double>(pieces);
  }
  return sum;
}

void hold(Bits& held, const Bits& seen) {
  for (std::size_t w = 0; w < held.size(); ++w) held[w] |= seen[w];
}

double seconds_between(const TourProblem& problem, const std::vector<int>& views, std::size_t to) {
  const auto view = static_cast<std::size_t>(views[to]);
  return to == 0 ? problem.first_seconds[view] : problem.seconds[static_cast<std::size_t>(views[to - 1])][view];
}

/// Tries changes of tours, at most a given number of them.
class TourSearch {
 public:
  TourSearch(const TourProblem& problem, const TourOptions& options)
      : problem_(problem), options_(options), all_(worth_of_all()) {}

  [[nodiscard]] Tour along(std::vector<int> views) const {
    return along(std::move(views), std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] Tour greedy(int first) const;
  [[nodiscard]] Tour improved(Tour tour) const;

 private:
  /// Ends early, with a cost of at least `limit`, where the time alone takes that.
  [[nodiscard]] Tour along(std::vector<int> views, double limit) const {
    Tour tour;
    tour.views = std::move(views);
    for (std::size_t i = 0; i < tour.views.size(); ++i) tour.seconds += seconds_between(problem_, tour.views, i);
    tour.cost = tour.seconds;
    if (tour.cost >= limit) return tour;
    Bits held(problem_.first_word.back(), 0);
    for (const int view : tour.views) hold(held, problem_.sees[static_cast<std::size_t>(view)]);
    tour.left = all_ - worth_of_new(problem_, held, Bits(held.size(), 0));
    const double whole = problem_.known + all_;
    if (whole > 0) tour.cost += options_.price * std::max(0.0, tour.left / whole - options_.left);
    return tour;
  }
  [[nodiscard]] double worth_of_all() const {
    Bits any(problem_.first_word.back(), 0);
    for (const Bits& seen : problem_.sees) hold(any, seen);
    return worth_of_new(problem_, any, Bits(any.size(), 0));
  }

  const TourProblem& problem_;
  const TourOptions& options_;
  double all_;
};

Tour TourSearch::greedy(int first) const {
  const double may_leave = options_.left * (problem_.known + all_);
  std::vector<int> views;
  Bits held(problem_.first_word.back(), 0);
  double left = all_;
  for (int next = first; next >= 0;) {
    views.push_back(next);
    const Bits& seen = problem_.sees[static_cast<std::size_t>(next)];
    left -= worth_of_new(problem_, seen, held);
    hold(held, seen);
    const int from = next;
    next = -1;
    if (left <= may_leave || static_cast<int>(views.size()) >= options_.most_views) break;
    double best = 0;
    for (std::size_t v = 0; v < problem_.sees.size(); ++v) {
      const double gained = std::min(left - may_leave, worth_of_new(problem_, problem_.sees[v], held));
      const double rate = gained / problem_.seconds[static_cast<std::size_t>(from)][v];
      if (rate > best) {
        best = rate;
        next = static_cast<int>(v);
      }
    }
  }
  return along(std::move(views));
}

/// Calls `visit(views)` for the changes of a tour in a fixed order until it returns true; whether it did.
template <class Visit>
bool visit_changes(const std::vector<int>& views, int candidates, int most_views, const Visit& visit) {
  const auto size = static_cast<std::ptrdiff_t>(views.size());
  for (std::ptrdiff_t i = 0; size > 1 && i < size; ++i) {
    std::vector<int> fewer = views;
    fewer.erase(fewer.begin() + i);
    if (visit(fewer)) return true;
  }
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    for (std::ptrdiff_t j = 0; j < size; ++j) {
      if (i == j) continue;
      std::vector<int> moved = views;
      moved.erase(moved.begin() + i);
      moved.insert(moved.begin() + j, views[static_cast<std::size_t>(i)]);
      if (visit(moved)) return true;
      if (i > j) continue;
      std::vector<int> turned = views;
      std::reverse(turned.begin() + i, turned.begin() + j + 1);
      if (visit(turned)) return true;
    }
  }
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    std::vector<int> replaced = views;
    for (int view = 0; view < candidates; ++view) {
      replaced[static_cast<std::size_t>(i)] = view;
      if (visit(replaced)) return true;
    }
  }
  for (std::ptrdiff_t i = 0; size < most_views && i <= size; ++i) {
    std::vector<int> more = views;
    more.insert(more.begin() + i, 0);
    for (int view = 0; view < candidates; ++view) {
      more[static_cast<std::size_t>(i)] = view;
      if (visit(more)) return true;
    }
  }
  return false;
}

Tour TourSearch::improved(Tour tour) const {
  constexpr double least_improvement = 1e-9;  // seconds: rounding alone is none
  int trials = 0;
  bool better = true;
  while (better && trials < options_.most_trials) {
    const std::vector<int> views = tour.views;
    better = visit_changes(views, static_cast<int>(problem_.sees.size()), options_.most_views,
                           [&](const std::vector<int>& changed) {
                             if (problem_.may_begin[static_cast<std::size_t>(changed.front())] == 0) return false;
                             if (++trials > options_.most_trials) return true;
                             Tour tried = along(changed, tour.cost - least_improvement);
                             if (tried.cost >= tour.cost - least_improvement) return false;
                             tour = std::move(tried);
                             return true;
                           });
  }
  return tour;
}

}  // namespace

Tour tour_along(const TourProblem& problem, const TourOptions& options, std::vector<int> views) {
  return TourSearch(problem, options).along(std::move(views));
}

std::vector<Tour> good_tours(const TourProblem& problem, const TourOptions& options) {
  const TourSearch search(problem, options);
  std::vector<int> firsts;
  for (std::size_t v = 0; v < problem.sees.size(); ++v) {
    if (problem.may_begin[v] != 0) firsts.push_back(static_cast<int>(v));
  }
  std::vector<Tour> tours(firsts.size());
  parallel_for(tours.size(), [&](std::size_t i) { tours[i] = search.greedy(firsts[i]); });
  const auto cheaper = [](const Tour& a, const Tour& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.views.front() < b.views.front();
  };
  std::sort(tours.begin(), tours.end(), cheaper);
  std::vector<Tour> improved(std::min(tours.size(), static_cast<std::size_t>(options.improved)));
  parallel_for(improved.size(), [&](std::size_t i) { improved[i] = search.improved(tours[i]); });
  // Exchanges may change the first view: each view keeps the cheapest tour that begins with it.
  for (const Tour& tour : improved) {
    const auto same =
        std::find_if(tours.begin(), tours.end(), [&](const Tour& t) { return t.views.front() == tour.views.front(); });
    if (tour.cost < same->cost) *same = tour;
  }
  std::sort(tours.begin(), tours.end(), cheaper);
  return tours;
}

}  // namespace vantage
