#include "vantage/server/session_request.hpp"

#include <algorithm>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {
namespace {

using Names = std::initializer_list<std::string_view>;

std::string listed(Names names) {
  std::string list;
  for (const std::string_view name : names) list += concat(list.empty() ? "" : ", ", name);
  return list.empty() ? "there is none" : "must be one of: " + list;
}

bool is_one_of(const std::string& name, Names names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void require_query(const HttpRequest& request, Names known) {
  for (const auto& [name, value] : request.query) {
    require(name == "token" || is_one_of(name, known), "parameter '", name, "': is not known; ", listed(known));
  }
}

int query_number(const HttpRequest& request, const std::string& name, int otherwise) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return otherwise;
  const std::string& text = found->second;
  require(!text.empty() && text.size() <= 6 && text.find_first_not_of("0123456789") == std::string::npos, name, " = '",
          text, "': must be a whole number from 0 to 999999");
  return leading_number(text);
}

bool query_is_yes(const HttpRequest& request, const std::string& name) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return true;
  require(found->second == "yes" || found->second == "no", name, " = '", found->second, "': must be yes or no");
  return found->second == "yes";
}

nlohmann::json body_object(const HttpRequest& request, Names known) {
  require_query(request, {});
  if (request.body.empty()) return nlohmann::json::object();
  nlohmann::json json = parse_json(request.body, "body");
  require(json.is_object(), "body: must be an object, is ", json.type_name());
  for (const auto& [key, value] : json.items()) {
    require(is_one_of(key, known), "body: key '", key, "' is not known; ", listed(known));
  }
  return json;
}

int body_candidate(const nlohmann::json& body, int views) {
  require(body.contains("candidate"), "body: has no 'candidate'; must be one of the views 0 .. ", views - 1);
  const nlohmann::json& value = body["candidate"];
  require(value.is_number_integer(), "candidate: must be a whole number, is ", value.type_name());
  require(value >= 0 && value < views, "candidate = ", value.dump(), ": must be one of the views 0 .. ", views - 1);
  return value.get<int>();
}

int body_scan(const nlohmann::json& body) {
  require(body.contains("number"), "body: has no 'number'; must be that of a scan");
  const nlohmann::json& value = body["number"];
  require(value.is_number_integer() && value >= 0 && value <= std::numeric_limits<int>::max(),
          "number = ", value.dump(), ": must be that of a scan");
  return value.get<int>();
}

std::string body_text(const nlohmann::json& body, const std::string& key) {
  require(body.contains(key) && body[key].is_string() && !body[key].get<std::string>().empty(), key,
          ": must be text that is not empty");
  require_plain_text(body[key].get<std::string>(), key);
  return body[key].get<std::string>();
}

nlohmann::ordered_json pose_json(const View& view) { return pose_numbers(view.world_from_sensor); }

}  // namespace vantage
