#pragma once

#include <cstdint>
#include <vector>

#include "vantage/robot/robot_time.hpp"
#include "vantage/utility/gain.hpp"

namespace vantage {

/// How the rest of a scan is planned.
struct TourOptions {
  RobotTime time;
  GainOptions gain;        // how views are looked at, what an unknown voxel is worth, and what has to overlap
  double left = 0.005;     // share of the expected surface that the tour may leave
  double price = 1000;     // seconds that leaving the whole expected surface beyond that counts
  int most_views = 12;     // of a tour
  int improved = 4;        // tours, the strongest, that exchanges improve
  int most_trials = 2000;  // exchanges of a tour

  /// Throws InputError naming the field.
  void validate() const;
};

/// What a tour is chosen from. Views are counted from 0; bits of `sees` are pieces of surface, weighted class by class.
struct TourProblem {
  std::vector<std::vector<std::uint64_t>> sees;  // of each view
  std::vector<std::size_t> first_word;           // of each class, and the end
  std::vector<double> worth;                     // of a piece of each class
  std::vector<double> first_seconds;             // from where the robot is, with the scan
  std::vector<std::vector<double>> seconds;      // seconds[from][to], with the scan
  std::vector<char> may_begin;                   // whether the tour may begin with the view
  double known = 0;                              // worth of what is known already
};

/// Views in their order with what they take and leave. `cost` is the time plus the price of what is left beyond the
/// share that may be.
struct Tour {
  std::vector<int> views;
  double seconds = 0;
  double left = 0;  // worth of the pieces that some view sees and the tour does not
  double cost = 0;
};

/// What a tour comes to: the definition.
[[nodiscard]] Tour tour_along(const TourProblem& problem, const TourOptions& options, std::vector<int> views);

/// A good tour for each view that may begin one, by greedy choice; the strongest improved by leaving out, moving,
/// turning round, replacing and adding views. Cheapest first, ties by the first view. The same for any number of
/// threads.
[[nodiscard]] std::vector<Tour> good_tours(const TourProblem& problem, const TourOptions& options);

/// Chooses the view that the best tour over the rest of the scan begins with. Its score is 1 / (1 + cost) of the best
/// tour that was found to begin with the view; 0 for views that overlap too little or meet nothing.
[[nodiscard]] Utility tour_utility(const TourOptions& options = {});

/// The best tour itself; empty where no view meets anything.
[[nodiscard]] std::vector<TourStop> best_tour(const Choice& choice, const TourOptions& options = {});

}  // namespace vantage
