#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vantage {

/// Parses JSON; throws InputError with `name`, line, column and what was found where it is not well formed or nested
/// deeper than 100 levels.
[[nodiscard]] nlohmann::json parse_json(std::string_view bytes, const std::string& name);

/// The value as a finite number; throws InputError starting with `what`.
[[nodiscard]] double json_number(const nlohmann::json& value, const std::string& what);

}  // namespace vantage
