#include "vantage/core/normal_points.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// The root above 1 of x^(d+1) = x + 1, which is the golden ratio for d = 1: its powers fill d dimensions evenly
/// (M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018).
double generalised_golden_ratio(int dimensions) {
  double x = 1.5;
  for (int i = 0; i < 60; ++i) x = std::pow(1 + x, 1.0 / (dimensions + 1));
  return x;
}

}  // namespace

double normal_quantile(double share) {
  require(share > 0 && share < 1, "normal_quantile: ", share, " must be in (0, 1)");
  // By symmetry the lower half is enough; there Newton's steps on a convex function from 0 never overshoot.
  if (share > 0.5) return -normal_quantile(1 - share);
  double x = 0;
  for (int i = 0; i < 200; ++i) {
    const double missing = share - 0.5 * std::erfc(-x / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
    const double step = missing / density;
    x += step;
    if (std::abs(step) <= 1e-14 * (1 + std::abs(x))) break;
  }
  return x;
}

Eigen::MatrixXd normal_points(int dimensions, int count) {
  require(dimensions >= 1 && count >= 2 * dimensions && count % 2 == 0, "normal points: ", count, " in ", dimensions,
          " dimensions: must be an even number, at least twice the dimensions");
  const int half = count / 2;
  const double ratio = generalised_golden_ratio(dimensions);
  Eigen::MatrixXd points(dimensions, count);
  for (int d = 0; d < dimensions; ++d) {
    const double step = std::pow(ratio, -(d + 1));
    for (int i = 0; i < half; ++i) {
      const double place = 0.5 + (i + 1) * step;
      points(d, i) = normal_quantile(place - std::floor(place));
    }
  }
  points.rightCols(half) = -points.leftCols(half);
  const Eigen::MatrixXd covariance = points * points.transpose() / count;
  return covariance.llt().matrixL().solve(points);
}

}  // namespace vantage
