#include "vantage/utility/utility.hpp"

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {

Utility voxel_utility(VoxelUtility judge_view) {
  const auto judge_all = [judge_view = std::move(judge_view)](const Choice& choice) {
    std::vector<double> scores(choice.views.size());
    parallel_for(scores.size(), [&](std::size_t i) {
      const ViewToJudge& view = choice.views[i];
      scores[i] = judge_view(choice, view, choice.visibility.visible_voxels(choice.camera, view.view, view.resolution));
    });
    return scores;
  };
  return {.score = SetUtility(judge_all)};
}

std::vector<double> judge(const Utility& utility, const Choice& choice) {
  std::vector<double> scores;
  if (const auto* by_counts = std::get_if<CountUtility>(&utility.score)) {
    scores.reserve(choice.views.size());
    for (const ViewToJudge& view : choice.views) scores.push_back((*by_counts)(view.seen, view.factors));
  } else {
    scores = std::get<SetUtility>(utility.score)(choice);
  }
  if (scores.size() != choice.views.size()) {
    throw Error(concat("utility: ", scores.size(), " scores for ", choice.views.size(), " views"));
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (std::isfinite(scores[i]) || (choice.deadline && scores[i] == not_judged)) continue;
    throw Error(concat("utility: the score of candidate ", choice.views[i].candidate, " is ", scores[i],
                       ": must be a finite number"));
  }
  return scores;
}

}  // namespace vantage
