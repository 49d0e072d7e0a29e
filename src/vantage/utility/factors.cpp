#include "vantage/utility/factors.hpp"

#include "vantage/core/error.hpp"

namespace vantage {

void UtilityOptions::validate() const {
  require(alpha_oc >= 0 && alpha_oc <= 1, "alpha_oc = ", alpha_oc, ": must be in [0, 1]");
  require(alpha_op >= 0 && alpha_op <= 1, "alpha_op = ", alpha_op, ": must be in [0, 1]");
  require(rho >= 0 && rho < 1, "rho = ", rho, ": must be in [0, 1)");
}

double desired_share(double x, double alpha) {
  const bool rising = alpha > 0 && (x <= alpha || alpha >= 1);
  if (rising) {  // eq. 5
    const double share = x / alpha;
    return share * share * (3 - 2 * share);
  }
  // Eq. 6 is eq. 5 seen from the other end: h2(x, alpha) = h1(1 - x, 1 - alpha).
  const double rest = (1 - x) / (1 - alpha);
  return rest * rest * (3 - 2 * rest);
}

double navigation_factor(double normalised_distance, double rho) {
  return (rho - 1) * normalised_distance * normalised_distance + 1;
}

Factors factors(const Visibility& seen, double normalised_distance, const UtilityOptions& options) {
  Factors result;
  result.f_navigation = options.navigation ? navigation_factor(normalised_distance, options.rho) : 0;
  const double voxels = static_cast<double>(seen.occupied) + seen.occplane + seen.unmarked;
  if (!(voxels > 0) || seen.rays <= 0) return result;
  result.x_oc = seen.occupied / voxels;
  result.x_op = seen.occplane / voxels;
  result.f_area = desired_share(result.x_oc, options.alpha_oc) + desired_share(result.x_op, options.alpha_op);
  result.f_quality = seen.occupied > 0 ? from_fixed_point(seen.cosine_sum) / seen.occupied : 0;
  result.f_occlusion = seen.occplane / static_cast<double>(seen.rays);
  return result;
}

double combined_utility(const Factors& f) { return f.f_area * (f.f_quality + f.f_navigation + f.f_occlusion); }

double gua_utility(const Factors& f) { return f.f_occlusion; }

}  // namespace vantage
