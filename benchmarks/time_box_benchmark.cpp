// How soon a search with a deadline meets a good view: the share of the best utility that is found in the first eighth
// and quarter of the views, by ViewQueue and in the order of indices. Mean over the maps after one to four scans.
#include <algorithm>
#include <numeric>
#include <string>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/search/view_queue.hpp"

namespace vantage::bench {
namespace {

const std::vector<std::string> candidate_sets{"sphere:80:2", "sphere:320:2", "sphere:1280:2", "cube:17:4.1:0.82:1.9"};

/// Best score after every round of n/8 views, over the best of all.
std::vector<double> shares(ViewQueue queue, const std::vector<Evaluation>& all) {
  std::vector<double> found;
  double best_so_far = 0;
  while (!queue.empty()) {
    std::vector<Evaluation> round;
    for (const int view : queue.next(all.size() / 8)) round.push_back(all[static_cast<std::size_t>(view)]);
    for (const Evaluation& each : round) best_so_far = std::max(best_so_far, each.score);
    queue.learn(round);
    found.push_back(best_so_far);
  }
  for (double& each : found) each /= best_so_far;
  return found;
}

double share_in_order(const std::vector<Evaluation>& all, std::size_t count) {
  double best = 0;
  double best_of_all = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    best_of_all = std::max(best_of_all, all[i].score);
    if (i < count) best = std::max(best, all[i].score);
  }
  return best / best_of_all;
}

void time_box(benchmark::State& state) {
  const Candidates candidates =
      candidates_from_text(candidate_sets[static_cast<std::size_t>(state.range(0))], Vec3::Zero());
  const RangeCamera camera = paper_camera();
  std::vector<int> indices(candidates.views.size());
  std::iota(indices.begin(), indices.end(), 0);
  double queue[2] = {}, order[2] = {};
  for (auto _ : state) {
    for (int scans = 1; scans <= 4; ++scans) {
      const VoxelMap& map = map_after_scans(scans);
      const VisibilityEvaluator visibility(map);
      const Travel travel{Travel::Path::orthodromic, Vec3::Zero(), 2};
      const ViewEvaluation problem{
          map,
          visibility,
          camera,
          candidates,
          map.grid().length,
          travel,
          scan_views()[static_cast<std::size_t>(scans - 1)],
          {},
          {.score = CountUtility([](const Visibility&, const Factors& f) { return combined_utility(f); })}};
      const std::vector<Evaluation> all = problem.evaluate(indices, std::span(&camera.resolution, 1));
      const std::vector<double> found = shares(ViewQueue(candidates, indices), all);
      for (std::size_t i : {0, 1}) {
        queue[i] += found[i] / 4;
        order[i] += share_in_order(all, (i + 1) * all.size() / 8) / 4;
      }
    }
  }
  state.SetLabel(candidate_sets[static_cast<std::size_t>(state.range(0))]);
  state.counters["queue_eighth"] = queue[0];
  state.counters["queue_quarter"] = queue[1];
  state.counters["index_eighth"] = order[0];
  state.counters["index_quarter"] = order[1];
}

BENCHMARK(time_box)->ArgName("set")->DenseRange(0, 3)->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage::bench
