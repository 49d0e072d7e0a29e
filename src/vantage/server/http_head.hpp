#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "vantage/server/admission.hpp"
#include "vantage/server/http_server.hpp"

namespace vantage {

/// What the head of a request says, as far as anything is decided by it.
struct HttpHead {
  std::string method;  // as it was sent
  std::string path;    // without the query, percent signs decoded
  std::map<std::string, std::string> query;
  std::string content_type;  // without parameters, lower case
  std::string boundary;      // its parameter of this name
  Caller caller;
};

/// The head of a request for `target` (path and query).
[[nodiscard]] HttpHead parse_target(std::string_view target);

/// The text before the body of an answer. Without `length` the body ends with the connection.
[[nodiscard]] std::string head_text(const HttpAnswer& answer, const std::string& cookie,
                                    std::optional<std::size_t> length);

}  // namespace vantage
