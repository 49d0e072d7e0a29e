#include "vantage/utility/met_voxels.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "vantage/core/parallel.hpp"
#include "vantage/visibility/voxel_place.hpp"

namespace vantage {
namespace {

constexpr std::size_t classes = MetVoxels::classes;

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

}  // namespace

double MetVoxels::worth(const std::array<double, classes>& of_class, const ClassCounts& counts) const {
  double sum = 0;
  for (std::size_t c = 0; c < classes; ++c) sum += of_class[c] * counts[c];
  return sum;
}

ClassCounts MetVoxels::counts(const std::vector<std::uint64_t>& view, const std::uint64_t* without) const {
  ClassCounts result{};
  for (std::size_t c = 0; c < classes; ++c) {
    for (std::size_t w = first_word[c]; w < first_word[c + 1]; ++w) {
      result[c] += std::popcount(without ? view[w] & ~without[w] : view[w]);
    }
  }
  return result;
}

std::vector<std::uint64_t> MetVoxels::any() const {
  std::vector<std::uint64_t> result(first_word[classes], 0);
  for (const std::vector<std::uint64_t>& view : of_view) {
    for (std::size_t w = 0; w < result.size(); ++w) result[w] |= view[w];
  }
  return result;
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

std::vector<char> overlapping(const MetVoxels& met, const std::vector<ClassCounts>& counts,
                              const std::vector<double>& worth, int refused, const GainOptions& options) {
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

}  // namespace vantage
