#pragma once

#include <Eigen/Core>

namespace vantage {

/// x with Phi(x) = `share` for the standard normal distribution; `share` in (0, 1).
[[nodiscard]] double normal_quantile(double share);

/// `count` points that stand for a standard normal distribution: one per column, equally weighted, always the same.
/// They follow an additive low-discrepancy sequence, come in pairs z and -z, and have exactly the mean 0 and the
/// covariance I, so that functions up to the third degree are averaged exactly. Throws InputError unless `count` is
/// even and at least twice the dimensions.
[[nodiscard]] Eigen::MatrixXd normal_points(int dimensions, int count);

}  // namespace vantage
