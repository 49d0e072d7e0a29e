#pragma once

#include <string>
#include <vector>

namespace vantage {

/// Throws InputError that names the option and the values it may have.
void require_one_of(const std::string& option, const std::string& value, const std::vector<std::string>& names);
/// The number that the whole text is; throws InputError that names the option where it is none or not finite.
[[nodiscard]] double number_from_text(const std::string& option, const std::string& text);
/// Numbers separated by commas, as many as asked for; throws InputError that names the option.
[[nodiscard]] std::vector<double> numbers_from_text(const std::string& option, const std::string& text,
                                                    std::size_t count);

}  // namespace vantage
