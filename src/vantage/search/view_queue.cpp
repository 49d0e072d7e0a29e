#include "vantage/search/view_queue.hpp"

#include <algorithm>
#include <limits>

namespace vantage {

ViewQueue::ViewQueue(const Candidates& candidates, std::span<const int> feasible)
    : candidates_(candidates), radius_(0) {
  for (const View& view : candidates.views) radius_ += (view.position() - candidates.center).norm();
  radius_ /= static_cast<double>(std::max<std::size_t>(candidates.views.size(), 1));
  waiting_.reserve(feasible.size());
  for (const int candidate : feasible) waiting_.push_back({candidate, std::numeric_limits<double>::infinity(), 0});
}

double ViewQueue::distance(int a, int b) const {
  const View& first = candidates_.views[static_cast<std::size_t>(a)];
  const View& second = candidates_.views[static_cast<std::size_t>(b)];
  return (first.position() - second.position()).squaredNorm() +
         (radius_ * (first.axis() - second.axis())).squaredNorm();
}

/// Again and again the one that is farthest from those taken before, beginning with the first.
std::vector<int> ViewQueue::take_spread(std::size_t count) {
  std::vector<int> taken;
  while (taken.size() < count && !waiting_.empty()) {
    const auto farthest = std::max_element(waiting_.begin(), waiting_.end(),
                                           [](const Waiting& a, const Waiting& b) { return a.distance < b.distance; });
    taken.push_back(farthest->candidate);
    waiting_.erase(farthest);
    for (Waiting& each : waiting_) each.distance = std::min(each.distance, distance(each.candidate, taken.back()));
  }
  for (Waiting& each : waiting_) each.distance = std::numeric_limits<double>::infinity();
  return taken;
}

std::vector<int> ViewQueue::next(std::size_t count) {
  if (!has_learned_) return take_spread(count);
  count = std::min(count, waiting_.size());
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(waiting_.begin(), end, waiting_.end(), [](const Waiting& a, const Waiting& b) {
    return a.promise != b.promise ? a.promise > b.promise : a.candidate < b.candidate;
  });
  std::vector<int> taken;
  for (auto each = waiting_.begin(); each != end; ++each) taken.push_back(each->candidate);
  waiting_.erase(waiting_.begin(), end);
  return taken;
}

void ViewQueue::learn(std::span<const Evaluation> evaluations) {
  has_learned_ = has_learned_ || !evaluations.empty();
  for (const Evaluation& evaluation : evaluations) {
    for (Waiting& each : waiting_) {
      const double d = distance(each.candidate, evaluation.candidate);
      if (d < each.distance) {
        each.distance = d;
        each.promise = evaluation.score;
      }
    }
  }
}

}  // namespace vantage
