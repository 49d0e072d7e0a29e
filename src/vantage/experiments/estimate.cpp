#include "vantage/experiments/estimate.hpp"

#include <cmath>
#include <numbers>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// The probability of a value between 0 and t. With t = sqrt(n) tan(a) the density becomes c cos(a)^(n-1), smooth on a
/// bounded interval, and Simpson's rule is exact to rounding.
double student_probability(double t, int n) {
  const double end = std::atan(t / std::sqrt(n));
  const double c = std::exp(std::lgamma((n + 1) / 2.0) - std::lgamma(n / 2.0)) / std::sqrt(std::numbers::pi);
  constexpr int steps = 400;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * std::pow(std::cos(end * i / steps), n - 1);
  }
  return c * sum * end / (3 * steps);
}

}  // namespace

double student_975(int degrees_of_freedom) {
  require(degrees_of_freedom >= 1, "degrees of freedom = ", degrees_of_freedom, ": must be at least 1");
  double low = 1.9, high = 13;
  while (high - low > 1e-12 * high) {
    const double middle = (low + high) / 2;
    (student_probability(middle, degrees_of_freedom) < 0.475 ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::optional<bool> Estimate::in_band() const {
  if (!band_low && !band_high) return std::nullopt;
  return (!band_low || mean >= *band_low) && (!band_high || mean <= *band_high);
}

Estimate estimate(const std::vector<double>& values) {
  require(!values.empty(), "there are no values to take the mean of");
  Estimate result;
  result.runs = static_cast<int>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    require(std::isfinite(values[i]), "value ", i, " of ", values.size(), " is ", values[i], ": must be finite");
    result.mean += values[i];
  }
  result.mean /= result.runs;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  double half = 0;
  if (result.runs > 1) {
    result.sd = std::sqrt(squares / (result.runs - 1));
    half = student_975(result.runs - 1) * result.sd / std::sqrt(result.runs);
  }
  result.low = result.mean - half;
  result.high = result.mean + half;
  return result;
}

Estimate paired_difference(const std::vector<double>& a, const std::vector<double>& b) {
  require(a.size() == b.size(), "paired difference of ", a.size(), " and ", b.size(), " values: must be as many");
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(b[i] - a[i]);
  return estimate(differences);
}

}  // namespace vantage
