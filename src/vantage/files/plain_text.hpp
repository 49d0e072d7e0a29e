#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// Whether the bytes are UTF-8: no overlong forms, no surrogates, nothing beyond U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// The text as it may be shown in a terminal or a log, one line: control characters (also those of C1, which begin
/// escape sequences too, line ends, and marks that turn the direction of writing) and bytes that are not UTF-8 become
/// \xNN.
[[nodiscard]] std::string printable(std::string_view text);

/// Refuses text that is not UTF-8, or of which printable() would show something else. Throws InputError with `what`.
void require_plain_text(std::string_view text, const std::string& what);

}  // namespace vantage
