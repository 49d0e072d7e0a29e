#include "vantage/utility/gain.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/visibility/voxel_place.hpp"

namespace vantage {
namespace {

constexpr std::size_t classes = 4;
constexpr std::array<int, 3> class_ends{1, 3, 7};  // steps

using Counts = std::array<std::int32_t, classes>;

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

/// The unknown voxels that the views meet, numbered class by class, each class from a new word on; and which of them
/// each view meets.
struct MetVoxels {
  std::array<std::size_t, classes + 1> first_word{};  // of each class, and the end
  std::vector<std::vector<std::uint64_t>> of_view;
  std::vector<std::int64_t> occupied;  // met, of each view
  std::vector<char> looked;            // whether there was time for the view

  [[nodiscard]] double worth(const std::array<double, classes>& of_class, const Counts& counts) const {
    double sum = 0;
    for (std::size_t c = 0; c < classes; ++c) sum += of_class[c] * counts[c];
    return sum;
  }
  /// How many of each class `view` meets that are not among `without`.
  [[nodiscard]] Counts counts(const std::vector<std::uint64_t>& view, const std::uint64_t* without) const {
    Counts result{};
    for (std::size_t c = 0; c < classes; ++c) {
      for (std::size_t w = first_word[c]; w < first_word[c + 1]; ++w) {
        result[c] += std::popcount(without ? view[w] & ~without[w] : view[w]);
      }
    }
    return result;
  }
};

/// Numbers of met voxels within their class: bit planes in the order of places, with a count before every word, so that
/// the largest map takes little more than its own planes.
class MetPlaces {
 public:
  explicit MetPlaces(std::size_t voxels) {
    for (std::vector<std::uint64_t>* plane : {&met_, &odd_, &upper_}) plane->resize((voxels + 63) / 64);
  }

  [[nodiscard]] bool contains(std::uint32_t place) const { return (met_[place >> 6U] >> (place & 63U) & 1U) != 0; }
  void add(std::uint32_t place, std::size_t of_class) {
    const std::uint64_t bit = std::uint64_t{1} << (place & 63U);
    met_[place >> 6U] |= bit;
    if ((of_class & 1U) != 0) odd_[place >> 6U] |= bit;
    if ((of_class & 2U) != 0) upper_[place >> 6U] |= bit;
  }
  /// After the last add(): how many there are of each class.
  [[nodiscard]] std::array<std::size_t, classes> number() {
    std::array<std::uint32_t, classes> used{};
    before_.resize(met_.size());
    for (std::size_t word = 0; word < met_.size(); ++word) {
      before_[word] = used;
      for (std::size_t c = 0; c < classes; ++c) used[c] += static_cast<std::uint32_t>(std::popcount(of_class(c, word)));
    }
    return {used[0], used[1], used[2], used[3]};
  }
  struct Slot {
    std::size_t of_class, number;
  };
  /// Of a place that was added.
  [[nodiscard]] Slot slot(std::uint32_t place) const {
    const std::size_t word = place >> 6U;
    const unsigned bit = place & 63U;
    const std::size_t c = (odd_[word] >> bit & 1U) + 2 * (upper_[word] >> bit & 1U);
    const std::uint64_t below = of_class(c, word) & ((std::uint64_t{1} << bit) - 1);
    return {c, before_[word][c] + static_cast<std::size_t>(std::popcount(below))};
  }

 private:
  [[nodiscard]] std::uint64_t of_class(std::size_t c, std::size_t word) const {
    return met_[word] & ((c & 1U) != 0 ? odd_[word] : ~odd_[word]) & ((c & 2U) != 0 ? upper_[word] : ~upper_[word]);
  }

  std::vector<std::uint64_t> met_, odd_, upper_;  // whether met, and the two bits of the class
  std::vector<std::array<std::uint32_t, classes>> before_;
};

std::size_t class_of(const std::array<BitPlane, 3>& near, const BitLayout& layout, const Index3& local) {
  const std::size_t word = layout.word(local);
  for (std::size_t c = 0; c < near.size(); ++c) {
    if ((near[c].words[word] & BitLayout::bit(local)) != 0) return c;
  }
  return near.size();
}

MetVoxels meet(const Choice& choice, const GainOptions& options) {
  const SightEvaluator evaluator(choice.map, options.grazing);
  MetVoxels met;
  std::vector<SightEvaluator::PackedSight> sights(choice.views.size());
  met.looked.assign(sights.size(), 0);
  std::atomic<std::size_t> next = 0;  // threads take views in their order, whichever loop index they run
  parallel_for(sights.size(), [&](std::size_t) {
    const std::size_t i = next++;
    if (choice.deadline && std::chrono::steady_clock::now() >= *choice.deadline) return;
    met.looked[i] = 1;
    const ViewToJudge& view = choice.views[i];
    const auto times = [&](int rays) {
      return std::max(1, static_cast<int>(std::lround(rays * options.rays_per_ideal)));
    };
    sights[i] = evaluator.see_packed(choice.camera, view.view, {times(view.ideal.columns), times(view.ideal.rows)});
  });

  const BitLayout& layout = choice.map.layout();
  const std::array<BitPlane, 3> near = unknown_near_occupied(choice.map);
  MetPlaces places(static_cast<std::size_t>(layout.size.cast<std::int64_t>().prod()));
  for (const SightEvaluator::PackedSight& sight : sights) {
    for (const std::uint32_t place : sight.unknown) {
      if (!places.contains(place)) places.add(place, class_of(near, layout, voxel_at(layout, place)));
    }
  }
  const std::array<std::size_t, classes> used = places.number();
  for (std::size_t c = 0; c < classes; ++c) met.first_word[c + 1] = met.first_word[c] + (used[c] + 63) / 64;
  met.of_view.resize(sights.size());
  met.occupied.resize(sights.size());
  parallel_for(sights.size(), [&](std::size_t i) {
    met.of_view[i].assign(met.first_word[classes], 0);
    met.occupied[i] = sights[i].occupied;
    for (const std::uint32_t place : sights[i].unknown) {
      const auto [of_class, number] = places.slot(place);
      met.of_view[i][met.first_word[of_class] + number / 64] |= std::uint64_t{1} << (number % 64);
    }
  });
  return met;
}

/// Which views overlap enough; the floor falls until there are some among those that gain anything.
std::vector<char> overlapping(const MetVoxels& met, const std::vector<Counts>& counts, const std::vector<double>& worth,
                              int refused, const GainOptions& options) {
  std::vector<double> overlap(worth.size(), 0.0);
  for (std::size_t i = 0; i < worth.size(); ++i) {
    const auto occupied = static_cast<double>(met.occupied[i]);
    const double all = occupied + std::accumulate(counts[i].begin(), counts[i].end(), 0);
    if (all > 0) overlap[i] = occupied / all;
  }
  std::vector<char> allowed(worth.size(), 0);
  constexpr double no_floor = 1e-3;
  const double raised = options.min_overlap * std::pow(options.refusal_step, refused);
  const double first_floor = std::max(options.min_overlap, std::min(raised, options.highest_floor));
  for (double floor = first_floor;; floor = floor > no_floor ? floor * options.floor_step : 0) {
    bool any = false;
    for (std::size_t i = 0; i < worth.size(); ++i) {
      allowed[i] = worth[i] > 0 && overlap[i] >= floor ? 1 : 0;
      any |= allowed[i] != 0;
    }
    if (any || floor == 0) return allowed;
  }
}

std::vector<double> gain(const Choice& choice, const GainOptions& options) {
  const MetVoxels met = meet(choice, options);
  const std::size_t views = met.of_view.size();
  std::vector<Counts> counts(views);
  std::vector<double> worth(views);
  std::vector<std::uint64_t> any(met.first_word[classes], 0);
  for (std::size_t i = 0; i < views; ++i) {
    counts[i] = met.counts(met.of_view[i], nullptr);
    worth[i] = met.worth(options.worth, counts[i]);
    for (std::size_t w = 0; w < any.size(); ++w) any[w] |= met.of_view[i][w];
  }
  const double all = met.worth(options.worth, met.counts(any, nullptr));
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
