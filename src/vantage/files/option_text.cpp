#include "vantage/files/option_text.hpp"

#include <charconv>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/text.hpp"

namespace vantage {

double number_from_text(const std::string& option, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size() && std::isfinite(value), option, ": '", text,
          "' is not a number");
  return value;
}

void require_one_of(const std::string& option, const std::string& value, const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    if (name == value) return;
    list += (list.empty() ? "" : ", ") + name;
  }
  throw InputError(concat(option, " = '", value, "': must be one of: ", list));
}

std::vector<double> numbers_from_text(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ',')) numbers.push_back(number_from_text(option, part));
  require(numbers.size() == count, option, ": '", text, "' has ", numbers.size(), " numbers; must have ", count);
  return numbers;
}

}  // namespace vantage
