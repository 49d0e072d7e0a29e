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

/// The value of a parameter in a header like `form-data; name=depth; filename="a b.png"` (RFC 2045: a word, or text in
/// quotes; names of parameters in any case), empty where it has none.
[[nodiscard]] std::string header_parameter(std::string_view header, std::string_view name);

/// The fields of a `multipart/form-data` body (RFC 7578) between lines of `boundary`, which the header Content-Type
/// names; what stands before the first and after the last one does not count (RFC 2046, 5.1). Throws InputError where
/// the body is something else, is cut off, or has a field without a name, one twice, or more than 16.
[[nodiscard]] std::vector<FormPart> parse_multipart(std::string_view body, std::string_view boundary);

}  // namespace vantage
