#pragma once

#include <optional>
#include <vector>

namespace vantage {

/// The mean of repeated runs, how far they spread, and what it is compared with.
struct Estimate {
  double mean = 0;
  double sd = 0;  // standard deviation of single runs; 0 for one run
  int runs = 0;
  double low = 0, high = 0;                   // 95 % confidence interval of the mean
  std::optional<double> published;            // the paper's value
  std::optional<double> band_low, band_high;  // where the mean should lie to reproduce the paper; either may be open

  /// Nothing without a band.
  [[nodiscard]] std::optional<bool> in_band() const;
};

/// Mean, standard deviation (n - 1) and the 95 % interval of the mean by Student's distribution; for one value the
/// interval is that value. Throws InputError for an empty list and for values that are not finite.
[[nodiscard]] Estimate estimate(const std::vector<double>& values);

/// The estimate of b - a, run by run. Throws InputError where the lengths differ.
[[nodiscard]] Estimate paired_difference(const std::vector<double>& a, const std::vector<double>& b);

/// The value that Student's distribution with that many degrees of freedom (at least 1) stays below with probability
/// 0.975.
[[nodiscard]] double student_975(int degrees_of_freedom);

}  // namespace vantage
