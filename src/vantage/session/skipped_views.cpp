#include "vantage/session/skipped_views.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/json_text.hpp"

namespace vantage {

std::string skipped_views_text(const std::map<int, std::string>& skipped) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [candidate, reason] : skipped) list.push_back({{"index", candidate}, {"reason", reason}});
  return list.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::map<int, std::string> parse_skipped_views(std::string_view bytes, const std::string& name) {
  const nlohmann::json list = parse_json(bytes, name);
  require(list.is_array(), name, ": must be a list");
  std::map<int, std::string> skipped;
  for (const nlohmann::json& each : list) {
    require(each.is_object() && each.contains("index") && each["index"].is_number_integer() &&
                each.contains("reason") && each["reason"].is_string(),
            name, ": each must have 'index' and 'reason'");
    const double index = json_number(each["index"], concat(name, ": index"));
    require(index >= 0 && index <= std::numeric_limits<int>::max(), name, ": index = ", index,
            ": must be the index of a view");
    skipped[static_cast<int>(index)] = each["reason"].get<std::string>();
  }
  return skipped;
}

}  // namespace vantage
