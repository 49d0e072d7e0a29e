#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "vantage/sensor/view.hpp"
#include "vantage/server/http_server.hpp"

namespace vantage {

// What requests to a session say. Each throws InputError that names what is wrong and what would be right.

/// Refuses parameters in the address other than these (and `token`).
void require_query(const HttpRequest& request, std::initializer_list<std::string_view> known);
/// A parameter that is a whole number of at most six digits, `otherwise` where it is missing.
[[nodiscard]] int query_number(const HttpRequest& request, const std::string& name, int otherwise);
/// A parameter that is `yes` or `no`, yes where it is missing.
[[nodiscard]] bool query_is_yes(const HttpRequest& request, const std::string& name);

/// The body, a JSON object with no other keys than these; an empty body is an empty object.
[[nodiscard]] nlohmann::json body_object(const HttpRequest& request, std::initializer_list<std::string_view> known);
/// The key `candidate`, one of so many views.
[[nodiscard]] int body_candidate(const nlohmann::json& body, int views);
/// A key that is text and not empty.
/// The number of a scan.
[[nodiscard]] int body_scan(const nlohmann::json& body);
[[nodiscard]] std::string body_text(const nlohmann::json& body, const std::string& key);

/// x y z qx qy qz qw, world from sensor.
[[nodiscard]] nlohmann::ordered_json pose_json(const View& view);

}  // namespace vantage
