#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

// Values by their place in the order of all: one definition of each.
namespace vantage {

/// The value at `place` (0: the smallest) if all were sorted.
template <class Value>
[[nodiscard]] Value value_at_place(std::vector<Value> values, std::size_t place) {
  const auto wanted = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), wanted, values.end());
  return *wanted;
}

/// The middle value, the upper one of two. There must be one.
template <class Value>
[[nodiscard]] Value upper_median(std::vector<Value> values) {
  const std::size_t middle = values.size() / 2;
  return value_at_place(std::move(values), middle);
}

/// The middle value, the mean of two. There must be one.
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// The value that lies this share of the way from the smallest to the largest, rounded down. There must be one.
[[nodiscard]] inline double lower_quantile(std::vector<double> values, double share) {
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return value_at_place(std::move(values), place);
}

/// The smallest of the sorted values that at least this share of them does not exceed. There must be one.
[[nodiscard]] inline double sorted_quantile(const std::vector<double>& sorted, double share) {
  const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp(count, std::size_t{1}, sorted.size()) - 1];
}

}  // namespace vantage
