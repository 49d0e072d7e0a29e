#include "vantage/registration/unposed_scans.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::size_t most_of_a_pair = 32;
constexpr double suggestion_error_in_cells = 1.5;

/// What two scans alone say of how they lie to each other.
std::vector<PoseHypothesis> between(const SurfaceFeatures& fixed, const SurfaceFeatures& moving) {
  return pose_hypotheses(fixed, moving, feature_matches(fixed, moving), {.most = most_of_a_pair});
}

struct Suggestion {
  Pose world_from_sensor;
  int support = 0;
};

/// RMS distance of the scan's places between two poses, metres.
double distance(const SurfaceFeatures& scan, const Pose& a, const Pose& b) {
  return distance_between(scan.places, a, b, 100);
}

/// Suggestions that are about the same speak together.
std::vector<Suggestion> pooled(const std::vector<Suggestion>& all, const SurfaceFeatures& scan) {
  std::vector<Suggestion> sums = all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j != i && distance(scan, all[i].world_from_sensor, all[j].world_from_sensor) < 3 * scan.cell)
        sums[i].support += all[j].support;
    }
  }
  std::stable_sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.support > b.support; });
  std::vector<Suggestion> kept;
  for (const Suggestion& each : sums) {
    const auto is_twin = [&](const Suggestion& other) {
      return distance(scan, each.world_from_sensor, other.world_from_sensor) < 2 * scan.cell;
    };
    if (std::none_of(kept.begin(), kept.end(), is_twin)) kept.push_back(each);
  }
  return kept;
}

/// Refuses a pose where features of the scans found so far speak for another one: symmetric shapes fit in several.
void refuse_minority(Registration& result, const std::vector<Suggestion>& all, const SurfaceFeatures& scan) {
  if (!result.succeeded() || all.empty()) return;
  constexpr double least_share = 0.6;
  constexpr double near_in_cells = 6;
  int here = 0;
  for (const Suggestion& each : all) {
    if (distance(scan, each.world_from_sensor, result.world_from_sensor) < near_in_cells * scan.cell)
      here = std::max(here, each.support);
  }
  const int most = all.front().support;
  if (here >= least_share * most) return;
  result.verdict = Verdict::ambiguous;
  result.value = static_cast<double>(here) / most;
  result.limit = least_share;
  result.explanation = concat(here, " features speak for where the scan fits best, but ", most, " for another pose");
}

/// Motions that lay a scan on itself, if only roughly: where it fits, it may fit in these as well.
std::vector<Pose> symmetries(const SurfaceFeatures& scan) {
  constexpr double near_in_cells = 6;
  std::vector<Pose> found;
  for (const PoseHypothesis& each : between(scan, scan)) {
    if (distance(scan, each.fixed_from_moving, Pose::Identity()) > near_in_cells * scan.cell && found.size() < 8)
      found.push_back(each.fixed_from_moving);
  }
  return found;
}

class PoseFinder {
 public:
  PoseFinder(const std::vector<ScanSurface>& scans, const AnywhereOptions& options)
      : scans_(scans), options_(options), found_(scans.size()), tried_(scans.size()) {
    double cell = 0;
    for (const ScanSurface& scan : scans) cell = std::max(cell, feature_cell(scan));
    options_.suggested_within = suggestion_error_in_cells * cell;
    for (const ScanSurface& scan : scans) features_.push_back(surface_features(scan.samples, cell));
    for (const SurfaceFeatures& each : features_) symmetries_.push_back(symmetries(each));
    pairs_.resize(scans.size() * scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      for (std::size_t j = i + 1; j < scans.size(); ++j) {
        pairs_[i * scans.size() + j] = between(features_[i], features_[j]);
        std::vector<PoseHypothesis> back = pairs_[i * scans.size() + j];
        for (PoseHypothesis& each : back) each.fixed_from_moving = each.fixed_from_moving.inverse();
        pairs_[j * scans.size() + i] = std::move(back);
      }
    }
  }

  [[nodiscard]] std::vector<UnposedScan> found() {
    if (scans_.empty()) return {};
    place(most_alike(), Pose::Identity());
    for (const Growth growth : {Growth::a_tenth, Growth::any}) {
      while (true) {
        const std::optional<std::size_t> next = most_supported(growth);
        if (!next) break;
        try_one(*next);
      }
    }
    in_frame_of_first();
    return found_;
  }

 private:
  /// How much more has to speak for the poses of a refused scan before it is tried again.
  enum class Growth { a_tenth, any };

  /// With what a scan was tried last.
  struct Tried {
    int support = -1;
    std::size_t placed = 0;
  };

  void try_one(std::size_t scan) {
    std::vector<Pose> poses;
    const std::vector<Suggestion> all = suggestions(scan);
    for (const Suggestion& each : all) {
      if (poses.size() < options_.coarse_poses) poses.push_back(each.world_from_sensor);
    }
    const std::vector<Pose> likely(poses.begin(), poses.begin() + std::min<std::ptrdiff_t>(4, std::ssize(poses)));
    for (const Pose& pose : likely) {
      for (const Pose& symmetry : symmetries_[scan]) poses.push_back(pose * symmetry);
    }
    tried_[scan] = {support(all), placed_};
    AnywhereRegistration result = register_anywhere(model_, scans_[scan], poses, options_);
    found_[scan].alternatives = std::move(result.alternatives);
    found_[scan].found = std::move(result.best);
    refuse_minority(found_[scan].found, all, features_[scan]);
    if (found_[scan].found.succeeded()) place(scan, found_[scan].found.world_from_sensor);
  }

  static int support(const std::vector<Suggestion>& all) { return all.empty() ? 0 : all.front().support; }

  void place(std::size_t scan, const Pose& pose) {
    model_.merge(scans_[scan], pose);
    found_[scan].world_from_sensor = pose;
    found_[scan].rank = placed_++;
  }

  [[nodiscard]] const std::vector<PoseHypothesis>& pair(std::size_t fixed, std::size_t moving) const {
    return pairs_[fixed * scans_.size() + moving];
  }

  /// Places that speak for how two scans lie to each other.
  [[nodiscard]] int likeness(std::size_t a, std::size_t b) const {
    return pair(a, b).empty() ? 0 : pair(a, b).front().support;
  }

  [[nodiscard]] std::size_t most_alike() const {
    std::size_t best = 0;
    int most = -1;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      int sum = 0;
      for (std::size_t j = 0; j < scans_.size(); ++j) sum += j == i ? 0 : likeness(i, j);
      if (sum > most) {
        most = sum;
        best = i;
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<Suggestion> suggestions(std::size_t scan) const {
    std::vector<Suggestion> all;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      const std::optional<Pose>& world_from_fixed = found_[i].world_from_sensor;
      if (!world_from_fixed) continue;
      for (const PoseHypothesis& each : pair(i, scan))
        all.push_back({*world_from_fixed * each.fixed_from_moving, each.support});
    }
    return pooled(all, features_[scan]);
  }

  /// The scan to try next: nothing where all that is left was tried with what is known now, or about that.
  [[nodiscard]] std::optional<std::size_t> most_supported(Growth growth) const {
    std::optional<std::size_t> best;
    int most = -1;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      const Tried& tried = tried_[i];
      if (found_[i].world_from_sensor || tried.placed == placed_) continue;
      const int now = support(suggestions(i));
      if (growth == Growth::a_tenth && tried.placed > 0 && now <= tried.support + tried.support / 10) continue;
      if (now <= most) continue;
      most = now;
      best = i;
    }
    return best;
  }

  void in_frame_of_first() {
    const std::optional<Pose>& world_from_first = found_[0].world_from_sensor;
    if (!world_from_first) return;
    const Pose first_from_world = world_from_first->inverse();
    for (UnposedScan& scan : found_) {
      if (scan.world_from_sensor) scan.world_from_sensor = first_from_world * *scan.world_from_sensor;
      for (Pose& pose : scan.alternatives) pose = first_from_world * pose;
    }
  }

  const std::vector<ScanSurface>& scans_;
  AnywhereOptions options_;
  std::vector<SurfaceFeatures> features_;
  std::vector<std::vector<Pose>> symmetries_;  // of each scan, in its frame
  std::vector<std::vector<PoseHypothesis>> pairs_;
  std::vector<UnposedScan> found_;
  std::vector<Tried> tried_;
  RegisteredSurface model_;
  std::size_t placed_ = 0;
};

}  // namespace

std::vector<Pose> suggested_poses(const std::vector<PosedFeatures>& known, const SurfaceFeatures& scan,
                                  std::size_t most) {
  std::vector<Suggestion> all;
  for (const PosedFeatures& each : known) {
    for (const PoseHypothesis& hypothesis : between(*each.features, scan))
      all.push_back({each.world_from_sensor * hypothesis.fixed_from_moving, hypothesis.support});
  }
  std::vector<Pose> poses;
  for (const Suggestion& each : pooled(all, scan)) {
    if (poses.size() < most) poses.push_back(each.world_from_sensor);
  }
  return poses;
}

std::vector<UnposedScan> find_poses(const std::vector<ScanSurface>& scans, const AnywhereOptions& options) {
  options.validate();
  return PoseFinder(scans, options).found();
}

}  // namespace vantage
