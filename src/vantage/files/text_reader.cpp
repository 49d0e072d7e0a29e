#include "vantage/files/text_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <type_traits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

template <class Number>
std::optional<Number> to_number(std::string_view text) {
  // std::from_chars knows no plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range && std::is_floating_point_v<Number> &&
      text.find_first_of("eE") != std::string_view::npos && text[text.find_first_of("eE") + 1] == '-') {
    return Number{0};  // too small for a double, which is no mistake of the file's writer
  }
  return error == std::errc{} ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<double> to_double(std::string_view text) { return to_number<double>(text); }
std::optional<std::int64_t> to_integer(std::string_view text) { return to_number<std::int64_t>(text); }
std::optional<std::uint64_t> to_unsigned(std::string_view text) { return to_number<std::uint64_t>(text); }

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
