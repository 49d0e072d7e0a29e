#include "vantage/utility/gain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/utility/met_voxels.hpp"

namespace vantage {
namespace {

constexpr std::array<int, 3> class_ends{1, 3, 7};  // steps

/// One 6-connected step of `from` into `into`.
BitPlane grown(const BitPlane& from, const BitPlane& into, const BitLayout& layout) {
  BitPlane result = from;
  for (int z = 0; z < layout.size.z(); ++z) {
    for (int y = 0; y < layout.size.y(); ++y) {
      const std::size_t row = layout.row(y, z);
      const auto neighbour = [&](int other_y, int other_z, std::size_t w) {
        const bool is_inside = other_y >= 0 && other_y < layout.size.y() && other_z >= 0 && other_z < layout.size.z();
        return is_inside ? from.words[layout.row(other_y, other_z) + w] : 0;
      };
      const auto words = static_cast<std::size_t>(layout.words_per_row);
      for (std::size_t w = 0; w < words; ++w) {
        std::uint64_t reached = from.words[row + w] << 1U | from.words[row + w] >> 1U;
        if (w > 0) reached |= from.words[row + w - 1] >> 63U;
        if (w + 1 < words) reached |= from.words[row + w + 1] << 63U;
        reached |= neighbour(y - 1, z, w) | neighbour(y + 1, z, w) | neighbour(y, z - 1, w) | neighbour(y, z + 1, w);
        result.words[row + w] |= reached & into.words[row + w];
      }
    }
  }
  return result;
}

std::vector<double> gain(const Choice& choice, const GainOptions& options) {
  const MetVoxels met = meet(choice, options);
  const std::size_t views = met.of_view.size();
  std::vector<ClassCounts> counts(views);
  std::vector<double> worth(views);
  for (std::size_t i = 0; i < views; ++i) {
    counts[i] = met.counts(met.of_view[i], nullptr);
    worth[i] = met.worth(options.worth, counts[i]);
  }
  const double all = met.worth(options.worth, met.counts(met.any(), nullptr));
  std::vector<double> scores(views, 0.0);
  for (std::size_t i = 0; i < views; ++i) {
    if (met.looked[i] == 0) scores[i] = not_judged;
  }
  if (!(all > 0)) return scores;

  const std::vector<char> allowed = overlapping(met, counts, worth, choice.refused, options);
  const double best = *std::max_element(worth.begin(), worth.end());
  const auto occupied = static_cast<double>(choice.map.count(Label::occupied));
  const bool is_last = all - best <= options.last_view_share * (all + occupied);
  std::vector<std::size_t> by_worth(views);
  std::iota(by_worth.begin(), by_worth.end(), std::size_t{0});
  std::stable_sort(by_worth.begin(), by_worth.end(), [&](std::size_t a, std::size_t b) { return worth[a] > worth[b]; });
  parallel_for(views, [&](std::size_t v) {
    if (allowed[v] == 0) return;
    double next = 0;
    for (const std::size_t u : by_worth) {
      if (is_last || worth[u] <= next) break;  // no later one can add more
      next = std::max(next, met.worth(options.worth, met.counts(met.of_view[u], met.of_view[v].data())));
    }
    // Travel as 1 - x keeps allowed views above 0.
    scores[v] = (worth[v] + options.lookahead * next) / all + options.travel * (1 - choice.views[v].travel);
  });
  return scores;
}

}  // namespace

void GainOptions::validate() const {
  grazing.validate();
  require(rays_per_ideal > 0 && rays_per_ideal <= 16, "rays-per-ideal = ", rays_per_ideal, ": must be in (0, 16]");
  for (const double each : worth) require(each >= 0 && each <= 1, "worth = ", each, ": must be in [0, 1]");
  require(lookahead >= 0 && lookahead <= 1, "lookahead = ", lookahead, ": must be in [0, 1]");
  require(travel >= 0 && travel <= 1, "travel = ", travel, ": must be in [0, 1]");
  require(min_overlap >= 0 && min_overlap <= 1, "min-overlap = ", min_overlap, ": must be in [0, 1]");
  require(floor_step > 0 && floor_step < 1, "floor-step = ", floor_step, ": must be in (0, 1)");
  require(refusal_step >= 1 && refusal_step <= 16, "refusal-step = ", refusal_step, ": must be in [1, 16]");
  require(highest_floor >= 0 && highest_floor <= 1, "highest-floor = ", highest_floor, ": must be in [0, 1]");
  require(last_view_share >= 0 && last_view_share <= 1, "last-view-share = ", last_view_share, ": must be in [0, 1]");
}

std::array<BitPlane, 3> unknown_near_occupied(const VoxelMap& map) {
  const BitLayout& layout = map.layout();
  BitPlane unknown = map.occupied();
  for (std::size_t w = 0; w < unknown.words.size(); ++w) {
    const auto in_row = static_cast<int>(w % static_cast<std::size_t>(layout.words_per_row));
    unknown.words[w] = ~(unknown.words[w] | map.empty().words[w]) & layout.row_mask(in_row);
  }
  std::array<BitPlane, 3> near;
  BitPlane reached = map.occupied();
  int steps = 0;
  for (std::size_t c = 0; c < near.size(); ++c) {
    for (; steps < class_ends[c]; ++steps) reached = grown(reached, unknown, layout);
    near[c] = reached;
    for (std::size_t w = 0; w < unknown.words.size(); ++w) near[c].words[w] &= unknown.words[w];
  }
  return near;
}

Utility gain_utility(const GainOptions& options) {
  options.validate();
  return {.score = SetUtility([options](const Choice& choice) { return gain(choice, options); }),
          .needs_all_views = true,
          .skips_scanned_views = true};
}

}  // namespace vantage
