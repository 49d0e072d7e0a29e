#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// One field of a form that was sent.
struct FormPart {
  std::string name, file_name;
  std::string_view body;  // in the bytes that were parsed
};

/// The fields of a `multipart/form-data` body (RFC 7578) without a preamble: its first line is the boundary. Throws
/// InputError where it is something else, is cut off, or has a field without a name, one twice, or more than 16.
[[nodiscard]] std::vector<FormPart> parse_multipart(std::string_view body);

}  // namespace vantage
