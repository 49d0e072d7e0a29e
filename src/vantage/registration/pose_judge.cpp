#include "vantage/registration/pose_judge.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/normal_points.hpp"

namespace vantage {
namespace {

/// For sentences: a share in per cent and a length in millimetres, rounded to what people read.
double percent(double share) { return std::round(1e3 * share) / 10; }
double millimetres(double metres) { return std::round(1e5 * metres) / 100; }
double rounded(double value) { return std::round(10 * value) / 10; }

/// The share that `count` samples stay below in 99.9 % of all cases where each is wrong with probability `share`.
double share_limit(double share, double count) {
  if (count <= 0) return 1;
  return share + normal_quantile(0.999) * std::sqrt(share * (1 - share) / count) + 1 / count;
}

template <class... Parts>
bool refuse(Registration& result, Verdict verdict, double value, double limit, const Parts&... parts) {
  result.verdict = verdict;
  result.value = value;
  result.limit = limit;
  result.explanation = concat(parts...);
  return true;
}

}  // namespace

Registration PoseJudge::judged(const std::vector<PoseMode>& modes) const {
  const PoseMode& best = modes.front();
  Registration result = described(best);
  result.rival_probability = rival(modes);
  const bool refused = refuse_overlap(best, result) || refuse_prior(best, result) || refuse_fit(best, result) ||
                       refuse_free_space(best, result) || refuse_open(result) || refuse_rival(result);
  if (!refused) accept(result);
  return result;
}

Registration PoseJudge::described(const PoseMode& mode) const {
  const PoseEvidence& evidence = mode.evidence;
  Registration result;
  result.world_from_sensor = mode.pose;
  result.covariance = mode.posterior.covariance;
  result.information = mode.posterior.information;
  result.undetermined_directions = static_cast<int>(mode.axes.open.cols());
  result.overlap = evidence.overlap();
  result.residual = evidence.on_surface > 0 ? std::sqrt(evidence.squared_distances / evidence.on_surface) : 0;
  result.prior_chi_squared = mode.u.squaredNorm();
  result.free_space_share = evidence.in_free_space / std::max(1.0, evidence.looked_at + evidence.on_surface);
  result.misplacement = search_.misplacement(mode.pose, mode.posterior.covariance);
  return result;
}

double PoseJudge::rival(const std::vector<PoseMode>& modes) const {
  double probability = 0;
  for (std::size_t i = 1; i < modes.size(); ++i) {
    if (search_.distance(modes[i].pose, modes[0].pose) < 2 * search_.cell()) continue;
    probability = std::max(probability, 1 / (1 + std::exp(modes[0].log_mass - modes[i].log_mass)));
  }
  return probability;
}

bool PoseJudge::refuse_overlap(const PoseMode& mode, Registration& result) const {
  const double count = mode.evidence.on_surface;
  if (count >= static_cast<double>(least_samples)) return false;
  return refuse(result, Verdict::insufficient_overlap, count, static_cast<double>(least_samples),
                percent(result.overlap), " % of the scan lies on the model: ", count, " samples; at least ",
                least_samples, " must");
}

bool PoseJudge::refuse_prior(const PoseMode& mode, Registration& result) const {
  if (!mode.converged) {
    return refuse(result, Verdict::not_converged, 0, 0, "the pose still moved after the last iteration");
  }
  const auto dimensions = static_cast<int>(search_.prior().dimensions());
  const double limit = dimensions > 0 ? chi_squared_limit(dimensions) : 0;
  if (result.prior_chi_squared <= limit) return false;
  return refuse(result, Verdict::beyond_prior, result.prior_chi_squared, limit, "the pose ended ",
                millimetres(search_.distance(mode.pose, search_.prior().mean())),
                " mm from the believed one, which the robot's error makes improbable: chi squared ",
                rounded(result.prior_chi_squared), "; at most ", limit, " (99.9 %)");
}

/// Surfaces that have nothing to do with each other lie within three standard deviations by chance (or half of them,
/// where noise fills the cells). What lies there beyond that has to be a third of what could: sensors err by more
/// than their noise where they are not calibrated, and surfaces bend.
bool PoseJudge::refuse_fit(const PoseMode& mode, Registration& result) const {
  const double by_chance = std::min(0.5, 3 * search_.typical_deviation() / search_.cell());
  const double limit = by_chance + (1 - by_chance) / 3;
  const double share = mode.evidence.on_surface / std::max(1.0, mode.evidence.near);
  if (share >= limit) return false;
  return refuse(result, Verdict::large_residual, share, limit, "of the scan's samples beside the model's surface ",
                percent(share), " % lie on it within three standard deviations; at least ", percent(limit), " % must");
}

bool PoseJudge::refuse_free_space(const PoseMode& mode, Registration& result) const {
  const double limit = share_limit(options_.outlier_share, mode.evidence.looked_at + mode.evidence.on_surface);
  if (result.free_space_share <= limit) return false;
  return refuse(result, Verdict::in_free_space, result.free_space_share, limit, percent(result.free_space_share),
                " % of the surfaces would stand where a range image looks through; at most ", percent(limit), " % may");
}

bool PoseJudge::refuse_open(Registration& result) const {
  const double largest = options_.largest_misplacement.value_or(std::max(3 * sigma_, 0.5 * search_.cell()));
  const double misplaced = 2 * result.misplacement;
  if (misplaced <= largest) return false;
  const int open = result.undetermined_directions;
  const std::string cause =
      open == 0 ? "the overlap says too little of the pose"
                : concat("the overlap leaves ", open, open > 1 ? " directions" : " direction", " of the pose open");
  return refuse(result, Verdict::degenerate, misplaced, largest, cause, ": surfaces may be ", millimetres(misplaced),
                " mm off; at most ", millimetres(largest), " mm may be");
}

bool PoseJudge::refuse_rival(Registration& result) const {
  if (result.rival_probability <= options_.ambiguity) return false;
  return refuse(result, Verdict::ambiguous, result.rival_probability, options_.ambiguity,
                "another pose is right with a probability of ", percent(result.rival_probability), " %; at most ",
                percent(options_.ambiguity), " % may be");
}

void PoseJudge::accept(Registration& result) const {
  result.verdict = Verdict::registered;
  result.value = result.misplacement;
  result.limit = options_.largest_misplacement.value_or(std::max(3 * sigma_, 0.5 * search_.cell())) / 2;
  result.explanation = concat(percent(result.overlap), " % of the scan lies on the model, ",
                              millimetres(result.residual), " mm (RMS) off it");
  if (result.undetermined_directions > 0) {
    result.explanation += concat(
        "; ", result.undetermined_directions, result.undetermined_directions > 1 ? " directions are" : " direction is",
        " not determined by the shape and ", result.undetermined_directions > 1 ? "stay" : "stays", " as believed");
  }
}

}  // namespace vantage
