#pragma once

#include <span>
#include <vector>

#include "vantage/search/search.hpp"

namespace vantage {

/// The order in which views are evaluated when there may be no time for all: first some that are spread over the
/// candidates, then those whose nearest evaluated view scored best. What a view sees changes little from one candidate
/// to its neighbour, so that good views come early.
class ViewQueue {
 public:
  ViewQueue(const Candidates& candidates, std::span<const int> feasible);

  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  /// Takes the next `count` candidates out, or as many as are left: spread where nothing has been evaluated yet.
  [[nodiscard]] std::vector<int> next(std::size_t count);
  /// Tells what evaluation found, for the order of those that wait.
  void learn(std::span<const Evaluation> evaluations);

 private:
  struct Waiting {
    int candidate;
    double distance;  // squared, to the nearest view that was evaluated
    double promise;   // that view's score
  };
  /// Squared; turning a view counts as moving it along the sphere of the candidates' mean radius.
  [[nodiscard]] double distance(int a, int b) const;
  [[nodiscard]] std::vector<int> take_spread(std::size_t count);

  const Candidates& candidates_;
  double radius_;
  std::vector<Waiting> waiting_;
  bool has_learned_ = false;
};

}  // namespace vantage
