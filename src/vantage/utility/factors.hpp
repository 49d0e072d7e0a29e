#pragma once

#include "vantage/visibility/visibility.hpp"

namespace vantage {

struct UtilityOptions {
  double alpha_oc = 0.2;   // desired share of occupied voxels, in [0, 1]
  double alpha_op = 0.8;   // desired share of occplane voxels, in [0, 1]
  double rho = 0.2;        // f_navigation of the farthest view, in [0, 1); the paper gives no value
  bool navigation = true;  // false: f_navigation is 0 (spec, section 4)

  void validate() const;
};

/// The factors of a view's utility (paper, section 5).
struct Factors {
  double x_oc = 0, x_op = 0;  // shares among n_oc + n_op + n_um
  double f_area = 0;          // eq. 7
  double f_navigation = 0;    // eq. 10
  double f_quality = 0;       // eq. 11
  double f_occlusion = 0;     // eq. 12
};

/// Eqs 4-6: 1 where the share x equals the desired one, 0 at both ends. For alpha = 0 or 1 the branch that remains.
[[nodiscard]] double desired_share(double x, double alpha);
/// Eq. 10 for a distance normalised to [0, 1].
[[nodiscard]] double navigation_factor(double normalised_distance, double rho);
[[nodiscard]] Factors factors(const Visibility& seen, double normalised_distance, const UtilityOptions& options);

/// Eq. 13.
[[nodiscard]] double combined_utility(const Factors& factors);
/// Eq. 21, the greatest unknown area.
[[nodiscard]] double gua_utility(const Factors& factors);

}  // namespace vantage
