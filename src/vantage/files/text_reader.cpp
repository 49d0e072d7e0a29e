#include "vantage/files/text_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"

namespace vantage {
namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

/// Bytes of the character that the text starts with; 0 where that is no valid UTF-8.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(0);
  const std::size_t count = first < 0x80   ? 1
                            : first < 0xc2 ? 0
                            : first < 0xe0 ? 2
                            : first < 0xf0 ? 3
                            : first < 0xf5 ? 4
                                           : 0;
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  }
  // Longer than needed, half of a surrogate pair, or beyond the last character.
  const bool is_outside = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) > 0x9f) ||
                          (first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) > 0x8f);
  return is_outside ? 0 : count;
}

}  // namespace

std::optional<double> to_double(std::string_view text) { return number_from<double>(text); }
std::optional<std::int64_t> to_integer(std::string_view text) { return number_from<std::int64_t>(text); }
std::optional<std::uint64_t> to_unsigned(std::string_view text) { return number_from<std::uint64_t>(text); }

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) {
    if (c >= ' ' && c <= '~') {
      result += c;
    } else {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return result + (text.size() > longest ? "...'" : "'");
}

std::string in_brackets(const Vec3& point) { return fmt::format("({}, {}, {})", point.x(), point.y(), point.z()); }

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.substr(0, mark.size()) == mark) text.remove_prefix(mark.size());
  return text;
}

std::string as_utf8(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t count = utf8_length(text.substr(at));
    if (count > 0) {
      result += text.substr(at, count);
    } else {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
    }
    at += std::max<std::size_t>(1, count);
  }
  return result;
}

bool TextReader::next_line() {
  if (rest_.empty()) {
    line_ = {};
    return false;
  }
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++line_number_;
  return true;
}

bool TextReader::next_line_with_words() {
  while (next_line()) {
    if (!at_end_of_line()) return true;
  }
  return false;
}

std::string_view TextReader::word() {
  const std::size_t first = line_.find_first_not_of(blanks);
  line_.remove_prefix(first == std::string_view::npos ? line_.size() : first);
  const std::string_view found = line_.substr(0, line_.find_first_of(blanks));
  line_.remove_prefix(found.size());
  return found;
}

double TextReader::number(std::string_view what) {
  const std::string_view text = word();
  if (text.empty()) fail(fmt::format("{} is missing", what));
  const auto value = to_double(text);
  if (!value) fail(fmt::format("{} = {}: must be a number", what, in_quotes(text)));
  return *value;
}

double TextReader::finite_number(std::string_view what) {
  const double value = number(what);
  if (!std::isfinite(value)) fail(fmt::format("{} = {}: must be a finite number", what, value));
  return value;
}

std::int64_t TextReader::integer(std::string_view what) {
  const std::string_view text = word();
  if (text.empty()) fail(fmt::format("{} is missing", what));
  const auto value = to_integer(text);
  if (!value) fail(fmt::format("{} = {}: must be a whole number", what, in_quotes(text)));
  return *value;
}

std::uint64_t TextReader::count(std::string_view what) {
  const std::string_view text = word();
  if (text.empty()) fail(fmt::format("{} is missing", what));
  const auto value = to_unsigned(text);
  if (!value) fail(fmt::format("{} = {}: must be a whole number, not negative", what, in_quotes(text)));
  return *value;
}

void TextReader::fail(std::string_view message) const {
  throw InputError(fmt::format("{}, line {}: {}", name_, line_number_, message));
}

}  // namespace vantage
