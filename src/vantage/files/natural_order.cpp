#include "vantage/files/natural_order.hpp"

#include <algorithm>

namespace vantage {
namespace {

/// The digits that the text starts with.
std::string_view leading_digits(std::string_view text) {
  return text.substr(0, std::min(text.find_first_not_of("0123456789"), text.size()));
}

std::string_view without_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

}  // namespace

bool comes_before(std::string_view a, std::string_view b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const std::string_view digits_a = leading_digits(rest_a), digits_b = leading_digits(rest_b);
    if (digits_a.empty() || digits_b.empty()) {
      if (rest_a[0] != rest_b[0]) return rest_a[0] < rest_b[0];
      rest_a.remove_prefix(1);
      rest_b.remove_prefix(1);
      continue;
    }
    const std::string_view number_a = without_zeros(digits_a), number_b = without_zeros(digits_b);
    if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
    if (number_a != number_b) return number_a < number_b;
    rest_a.remove_prefix(digits_a.size());
    rest_b.remove_prefix(digits_b.size());
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;
}

}  // namespace vantage
