#include "vantage/files/option_text.hpp"

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/core/text.hpp"

namespace vantage {

double number_from_text(const std::string& option, const std::string& text) {
  const std::optional<double> value = number_from<double>(text);
  require(value && std::isfinite(*value), option, ": '", text, "' is not a number");
  return value.value_or(0);
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
