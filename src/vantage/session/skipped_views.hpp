#pragma once

#include <map>
#include <string>
#include <string_view>

namespace vantage {

/// Candidates that are not planned, each with the reason, as JSON that parse_skipped_views() reads.
[[nodiscard]] std::string skipped_views_text(const std::map<int, std::string>& skipped);
/// Throws InputError starting with `name` where the bytes are something else.
[[nodiscard]] std::map<int, std::string> parse_skipped_views(std::string_view bytes, const std::string& name);

}  // namespace vantage
