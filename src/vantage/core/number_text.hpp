#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

// Numbers as people and programs write them, whatever the locale.
namespace vantage {

/// The number that the whole text is; nothing where it is another text or beyond what `Number` holds. Real numbers that
/// are too small for it are 0, which is no mistake of the writer; they may be infinite or not a number.
template <class Number>
[[nodiscard]] std::optional<Number> number_from(std::string_view text) {
  // std::from_chars knows no plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range && std::is_floating_point_v<Number> &&
      text.find_first_of("eE") != std::string_view::npos && text[text.find_first_of("eE") + 1] == '-') {
    return Number{0};
  }
  return error == std::errc{} ? std::optional(value) : std::nullopt;
}

/// The whole number of digits alone that the text begins with; 0 where it begins with none.
[[nodiscard]] inline int leading_number(std::string_view text) {
  return number_from<int>(text.substr(0, text.find_first_not_of("0123456789"))).value_or(0);
}

}  // namespace vantage
