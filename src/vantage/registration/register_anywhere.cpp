#include "vantage/registration/register_anywhere.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/registration/pose_judge.hpp"
#include "vantage/registration/sample_choice.hpp"
#include "vantage/registration/valley.hpp"

namespace vantage {
namespace {

/// Middle of a scan's samples and how far they are from it (RMS), sensor frame, metres.
struct Extent {
  Vec3 middle = Vec3::Zero();
  double radius = 0;
};

Extent extent_of(const ScanSurface& scan) {
  Extent extent;
  for (const SurfaceSample& sample : scan.samples) extent.middle += sample.point;
  extent.middle /= static_cast<double>(scan.samples.size());
  double squares = 0;
  for (const SurfaceSample& sample : scan.samples) squares += (sample.point - extent.middle).squaredNorm();
  extent.radius = std::sqrt(squares / static_cast<double>(scan.samples.size()));
  return extent;
}

/// What is believed of a pose that puts the scan's samples off by `reach` metres (RMS): half of it by shifting them,
/// half by turning them about their middle.
PoseEstimate about(const Pose& pose, const Extent& extent, double reach) {
  constexpr double most_turned = 0.5;  // radians
  const double shift = reach / std::sqrt(6.0);
  const double turn = std::min(most_turned, reach / (2 * std::max(1e-9, extent.radius)));
  const PoseEstimate of_middle = PoseEstimate::around(pose, shift, turn);
  const Mat6 effect = effect_at(pose.linear() * -extent.middle);
  const Mat6 covariance = effect * of_middle.covariance * effect.transpose();
  return {pose, 0.5 * (covariance + covariance.transpose())};
}

/// The scan with as many samples of each direction of normals as there are: a table counts no more than what stands on
/// it.
ScanSurface balanced(const ScanSurface& scan) {
  constexpr std::size_t enough = 1000;
  ScanSurface result = scan;
  result.samples = picked_by_normal(scan.samples, std::max(enough, scan.samples.size() / 3));
  return result;
}

/// How well a pose explains the scan where nothing else speaks for it: what would lie where nothing has been seen yet
/// counts as if it lay on the model. A pose does not become improbable by showing something new, as it does where a
/// pose is believed.
double log_credit(const PoseMode& mode) {
  constexpr double of_a_match = 4;
  constexpr double shared_variance = 0.01;
  const PoseEvidence& evidence = mode.evidence;
  const double samples = evidence.near + evidence.unseen;
  return (evidence.log_likelihood + of_a_match * evidence.unseen) / (1 + shared_variance * samples);
}

/// Probability of a pose against a better one. What speaks for it counts in full unless its overlap is much less.
double probability(const PoseMode& mode, const PoseMode& best) {
  constexpr double least_of_overlap = 0.3;
  const double by_overlap = 1 / (1 + std::exp(best.log_mass - mode.log_mass));
  if (mode.evidence.on_surface < least_of_overlap * best.evidence.on_surface) return by_overlap;
  return std::max(by_overlap, 1 / (1 + std::exp(log_credit(best) - log_credit(mode))));
}

class AnywhereSearch {
 public:
  AnywhereSearch(const RegisteredSurface& model, const ScanSurface& scan, const AnywhereOptions& options)
      : model_(model),
        whole_(scan),
        scan_(balanced(scan)),
        options_(options),
        extent_(extent_of(scan_)),
        spread_(coarse_spread(model, scan_)) {}

  [[nodiscard]] AnywhereRegistration found(const std::vector<Pose>& suggested) const {
    std::vector<PoseMode> peaks = fine_peaks(coarse_peaks(suggested, std::max(options_.suggested_within, spread_)));
    AnywhereRegistration result;
    if (peaks.empty()) {
      result.best.explanation = "no features of the scan agree on a pose";
      return result;
    }
    // Symmetric shapes and smooth ones fit elsewhere, where no feature may suggest it.
    const std::vector<Pose> valleys =
        poses_along_valleys({peaks.front().pose, peaks.front().posterior.covariance}, scan_.samples, 2 * spread_);
    for (PoseMode& peak : fine_peaks(coarse_peaks(valleys, std::max(2 * spread_, 0.2 * extent_.radius))))
      peaks.push_back(std::move(peak));
    sort(peaks);
    const PoseSearch search(model_, scan_, believed(peaks.front().pose), options_.registration.starts,
                            options_.registration.still);
    std::vector<PoseMode> modes = search.modes();
    modes.insert(modes.end(), peaks.begin() + 1, peaks.end());
    sort(modes);
    result.best = PoseJudge(search, options_.registration, std::max(model_.sigma(), scan_.sigma)).judged(modes);
    if (result.best.verdict == Verdict::in_free_space) judge_all_samples(result.best, modes);
    for (std::size_t i = 1; i < modes.size(); ++i) {
      if (distance(modes[i].pose, modes[0].pose) < 2 * search.cell()) continue;
      const double rival = probability(modes[i], modes[0]);
      if (rival > options_.registration.ambiguity) result.alternatives.push_back(modes[i].pose);
      result.best.rival_probability = std::max(result.best.rival_probability, rival);
    }
    if (result.best.succeeded()) refuse_guess(result.best);
    return result;
  }

 private:
  [[nodiscard]] PoseEstimate believed(const Pose& pose) const { return about(pose, extent_, 4 * spread_); }

  /// What moved has more weight among balanced samples than it has in the scan.
  void judge_all_samples(Registration& result, std::vector<PoseMode> modes) const {
    const PoseSearch search(model_, whole_, believed(modes.front().pose), options_.registration.starts,
                            options_.registration.still);
    PoseMode start;
    start.u = Eigen::VectorXd::Zero(search.prior().dimensions());
    modes.front() = search.fine_peak(std::move(start));
    const Registration of_all =
        PoseJudge(search, options_.registration, std::max(model_.sigma(), scan_.sigma)).judged({modes.front()});
    if (of_all.verdict != Verdict::in_free_space) result = of_all;
  }

  /// Where nothing is believed, a pose must follow from the surfaces alone, in all directions.
  void refuse_guess(Registration& result) const {
    const std::vector<ScanMotion> motions = motions_of_error(result.estimate(), scan_.samples);
    const double open = motions.empty() ? 0 : 2 * motions.front().deviation;
    const double most = options_.registration.ambiguity;
    const double limit = std::max(2 * model_.surfels().cell(), 3 * std::max(model_.sigma(), scan_.sigma));
    if (open > limit) {
      result.verdict = Verdict::ambiguous;
      result.value = open;
      result.limit = limit;
      result.explanation = concat("the shape leaves open where the scan lies by ", std::round(1e4 * open) / 10,
                                  " mm; at most ", std::round(1e4 * limit) / 10, " mm may be open without a pose");
    } else if (result.rival_probability > most) {
      result.verdict = Verdict::ambiguous;
      result.value = result.rival_probability;
      result.limit = most;
      result.explanation =
          concat("the scan fits elsewhere as well, with a probability of ",
                 std::round(1e3 * result.rival_probability) / 10, " %; at most ", 100 * most, " % may be");
    } else if (result.overlap < options_.least_overlap) {
      result.verdict = Verdict::insufficient_overlap;
      result.value = result.overlap;
      result.limit = options_.least_overlap;
      result.explanation = concat(std::round(1e3 * result.overlap) / 10, " % of the scan lies on the model; at least ",
                                  std::round(1e3 * options_.least_overlap) / 10, " % must without a pose");
    }
  }

  /// Peaks that the poses lead to, which put surfaces off by `reach` metres (RMS).
  [[nodiscard]] std::vector<PoseMode> coarse_peaks(const std::vector<Pose>& poses, double reach) const {
    std::vector<PoseMode> all(poses.size());
    parallel_for(poses.size(), [&](std::size_t i) {
      const PoseSearch search(model_, scan_, about(poses[i], extent_, reach), options_.registration.starts,
                              options_.registration.still);
      all[i] = search.coarse_peak();
      all[i].log_mass = all[i].evidence.log_likelihood;
    });
    return different(std::move(all));
  }

  [[nodiscard]] std::vector<PoseMode> fine_peaks(const std::vector<PoseMode>& coarse) const {
    std::vector<PoseMode> all(coarse.size());
    parallel_for(coarse.size(), [&](std::size_t i) {
      Pose pose = coarse[i].pose;
      // Once more from where the first ended, so that every peak is weighed with a prior of its own middle.
      for (int pass = 0; pass < 2; ++pass) {
        const PoseSearch search(model_, scan_, believed(pose), options_.registration.starts,
                                options_.registration.still);
        PoseMode start;
        start.u = Eigen::VectorXd::Zero(search.prior().dimensions());
        all[i] = search.fine_peak(std::move(start));
        pose = all[i].pose;
      }
    });
    return different(std::move(all));
  }

  static void sort(std::vector<PoseMode>& modes) {
    std::stable_sort(modes.begin(), modes.end(),
                     [](const PoseMode& a, const PoseMode& b) { return a.log_mass > b.log_mass; });
  }

  /// The best ones, by what speaks for them and by what does not speak against them, none of which is another one's
  /// twin.
  [[nodiscard]] std::vector<PoseMode> different(std::vector<PoseMode> all) const {
    sort(all);
    std::vector<std::size_t> by_credit(all.size());
    std::iota(by_credit.begin(), by_credit.end(), std::size_t{0});
    std::stable_sort(by_credit.begin(), by_credit.end(),
                     [&](std::size_t a, std::size_t b) { return log_credit(all[a]) > log_credit(all[b]); });
    std::vector<PoseMode> kept;
    const auto keep = [&](const PoseMode& mode, std::size_t most) {
      if (kept.size() >= most || mode.evidence.on_surface < 0.3 * all.front().evidence.on_surface) return;
      const auto is_twin = [&](const PoseMode& other) { return distance(other.pose, mode.pose) < 2 * spread_; };
      if (std::none_of(kept.begin(), kept.end(), is_twin)) kept.push_back(mode);
    };
    for (const PoseMode& mode : all) keep(mode, options_.fine_poses);
    for (const std::size_t i : by_credit) keep(all[i], 2 * options_.fine_poses);
    sort(kept);
    return kept;
  }

  /// RMS distance of the scan's samples between two poses, metres.
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const {
    return distance_between(scan_.samples, a, b, 300);
  }

  const RegisteredSurface& model_;
  const ScanSurface& whole_;
  ScanSurface scan_;  // balanced
  AnywhereOptions options_;
  Extent extent_;
  double spread_;  // metres
};

}  // namespace

void AnywhereOptions::validate() const {
  registration.validate();
  require(coarse_poses >= 1 && fine_poses >= 2, "coarse_poses = ", coarse_poses, ", fine_poses = ", fine_poses,
          ": must be at least 1 and 2");
  require(suggested_within >= 0, "suggested_within = ", suggested_within, " m: must not be negative");
  require(least_overlap >= 0 && least_overlap <= 1, "least_overlap = ", least_overlap, ": must be in [0, 1]");
}

AnywhereRegistration register_anywhere(const RegisteredSurface& model, const ScanSurface& scan,
                                       const std::vector<Pose>& suggested, const AnywhereOptions& options) {
  options.validate();
  const std::size_t surfels = model.empty() ? 0 : model.surfels().surfels().size();
  if (scan.samples.size() < least_samples || surfels < least_samples) {
    // The same refusal, whatever is believed.
    return {register_scan(model, scan, PoseEstimate(), options.registration), {}};
  }
  return AnywhereSearch(model, scan, options).found(suggested);
}

}  // namespace vantage
