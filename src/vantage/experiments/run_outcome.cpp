#include "vantage/experiments/run_outcome.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

template <class Map>
const auto& find(const Map& map, const std::string& kind, const std::string& name) {
  const auto found = map.find(name);
  if (found != map.end()) return found->second;
  std::string known;
  for (const auto& [key, value] : map) known += (known.empty() ? "" : ", ") + key;
  throw InputError(concat("a run has no ", kind, " '", name, "'; it has: ", known));
}

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json list_json(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number_json(value));
  return list;
}

Json lists_json(const std::map<std::string, std::vector<double>>& lists) {
  Json result = Json::object();
  for (const auto& [name, values] : lists) result[name] = list_json(values);
  return result;
}

double number_from(const nlohmann::json& value, const std::string& name) {
  if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
  require(value.is_number(), name, ": '", value.dump(), "' must be a number");
  return value.get<double>();
}

const nlohmann::json& object_in(const nlohmann::json& parent, const char* key, const std::string& name) {
  require(parent.is_object() && parent.contains(key) && parent[key].is_object(), name, ": '", key,
          "' must be an object");
  return parent[key];
}

std::map<std::string, std::vector<double>> lists_from(const nlohmann::json& object, const std::string& name) {
  std::map<std::string, std::vector<double>> lists;
  for (const auto& [key, values] : object.items()) {
    require(values.is_array(), name, ": '", key, "' must be a list");
    for (const auto& value : values) lists[key].push_back(number_from(value, concat(name, ": ", key)));
    if (values.empty()) lists[key] = {};
  }
  return lists;
}

}  // namespace

double RunOutcome::number(const std::string& name) const { return find(numbers, "number", name); }
const std::vector<double>& RunOutcome::list(const std::string& name) const { return find(lists, "list", name); }
const std::vector<double>& RunOutcome::time(const std::string& name) const { return find(times, "time", name); }

Json outcome_json(const RunOutcome& outcome) {
  Json numbers = Json::object();
  for (const auto& [name, value] : outcome.numbers) numbers[name] = number_json(value);
  Json texts = Json::object();
  for (const auto& [name, text] : outcome.texts) texts[name] = text;
  return {{"numbers", numbers}, {"texts", texts}, {"lists", lists_json(outcome.lists)}};
}

Json times_json(const RunOutcome& outcome) { return lists_json(outcome.times); }

RunOutcome outcome_from_json(const nlohmann::json& outcome, const nlohmann::json& times, const std::string& name) {
  RunOutcome result;
  for (const auto& [key, value] : object_in(outcome, "numbers", name).items())
    result.numbers[key] = number_from(value, concat(name, ": ", key));
  for (const auto& [key, value] : object_in(outcome, "texts", name).items()) {
    require(value.is_string(), name, ": '", key, "' must be a text");
    result.texts[key] = value.get<std::string>();
  }
  result.lists = lists_from(object_in(outcome, "lists", name), name);
  require(times.is_object(), name, ": the times must be an object");
  result.times = lists_from(times, name);
  return result;
}

std::vector<double> numbers(const std::vector<RunOutcome>& outcomes, const std::string& name) {
  return each(outcomes, [&name](const RunOutcome& outcome) { return outcome.number(name); });
}

double after_scan(const RunOutcome& outcome, const std::string& name, std::size_t scan) {
  const std::vector<double>& values = outcome.list(name);
  require(scan >= 1 && !values.empty(), name, " after scan ", scan, ": scans count from 1");
  return values[std::min(scan, values.size()) - 1];
}

}  // namespace vantage
