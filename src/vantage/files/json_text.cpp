#include "vantage/files/json_text.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"

namespace vantage {

nlohmann::json parse_json(std::string_view bytes, const std::string& name) {
  constexpr int deepest = 100;  // what we read is flat; walking over deep values would need deep recursion
  bool too_deep = false;
  const auto limit_depth = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    too_deep = too_deep || depth > deepest;
    return !too_deep;  // what is refused here is left out of the result
  };
  try {
    nlohmann::json value = nlohmann::json::parse(bytes.begin(), bytes.end(), limit_depth);
    require(!too_deep, name, ": is nested deeper than ", deepest, " levels");
    return value;
  } catch (const nlohmann::json::exception& error) {
    // The library's text starts with "[json.exception.parse_error.101] ", of no use to a user.
    const std::string text = error.what();
    const std::size_t end = text.find("] ");
    throw InputError(name + ": " + (end == std::string::npos ? text : text.substr(end + 2)));
  }
}

double json_number(const nlohmann::json& value, const std::string& what) {
  require(value.is_number(), what, ": must be a number, is ", value.type_name());
  const double number = value.get<double>();
  require(std::isfinite(number), what, ": must be a finite number");
  return number;
}

}  // namespace vantage
