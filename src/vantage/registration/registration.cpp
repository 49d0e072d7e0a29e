#include "vantage/registration/registration.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/registration/pose_judge.hpp"

namespace vantage {

void RegistrationOptions::validate() const {
  require(starts >= 12 && starts <= 10000 && starts % 2 == 0, "starts = ", starts,
          ": must be an even number from 12 to 10000");
  require(outlier_share >= 0 && outlier_share < 1, "outlier_share = ", outlier_share, ": must be in [0, 1)");
  require(!largest_misplacement || *largest_misplacement > 0,
          "largest_misplacement = ", largest_misplacement.value_or(0), " m: must be positive");
  require(ambiguity > 0 && ambiguity <= 0.5, "ambiguity = ", ambiguity, ": must be in (0, 0.5]");
}

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::registered:
      return "registered";
    case Verdict::insufficient_overlap:
      return "insufficient overlap";
    case Verdict::not_converged:
      return "not converged";
    case Verdict::beyond_prior:
      return "beyond prior";
    case Verdict::large_residual:
      return "large residual";
    case Verdict::degenerate:
      return "degenerate";
    case Verdict::in_free_space:
      return "in free space";
    case Verdict::ambiguous:
      return "ambiguous";
  }
  return "unknown";
}

Registration register_scan(const RegisteredSurface& model, const ScanSurface& scan,
                           const PoseEstimate& world_from_sensor, const RegistrationOptions& options) {
  options.validate();
  world_from_sensor.validate();
  const std::size_t surfels = model.empty() ? 0 : model.surfels().surfels().size();
  if (scan.samples.size() < least_samples || surfels < least_samples) {
    Registration result;
    result.world_from_sensor = world_from_sensor.mean;
    result.covariance = world_from_sensor.covariance;
    result.value = static_cast<double>(std::min(scan.samples.size(), surfels));
    result.limit = static_cast<double>(least_samples);
    result.explanation = concat("the scan has ", scan.samples.size(), " samples of a surface and the model ", surfels,
                                "; both need ", least_samples);
    return result;
  }
  const PoseSearch search(model, scan, world_from_sensor, options.starts, options.still);
  return PoseJudge(search, options, std::max(model.sigma(), scan.sigma)).judged(search.modes());
}

Registration register_pair(const ScanSurface& fixed, const ScanSurface& moving, const PoseEstimate& fixed_from_moving,
                           const RegistrationOptions& options) {
  RegisteredSurface model;
  model.merge(fixed, Pose::Identity());
  return register_scan(model, moving, fixed_from_moving, options);
}

}  // namespace vantage
