#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// The number that the whole text spells ("-1.5e-3", "+2", "nan", "inf"), in no locale; nothing otherwise.
[[nodiscard]] std::optional<double> to_double(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> to_integer(std::string_view text);
[[nodiscard]] std::optional<std::uint64_t> to_unsigned(std::string_view text);

/// The text in quotes for an error message: shortened to 40 characters, with unprintable bytes as \xNN.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The point as "(x, y, z)" for an error message.
[[nodiscard]] std::string in_brackets(const Vec3& point);

/// The text without spaces, tabs and line ends at both sides.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The text without the mark of UTF-8 that some editors put before it.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// The text as valid UTF-8, for files and answers that must be: bytes that are none become \xNN.
[[nodiscard]] std::string as_utf8(std::string_view text);

/// Walks over a text line by line and word by word, and words its errors as "NAME, line N: ...". Lines end in \n or
/// \r\n; words are separated by spaces and tabs. A byte order mark before the first line is no part of it.
class TextReader {
 public:
  /// The bytes must outlive the reader; `name` is what errors call the input, usually its path.
  TextReader(std::string_view bytes, std::string name)
      : rest_(without_byte_order_mark(bytes)), name_(std::move(name)) {}

  /// Moves to the next line; false at the end.
  bool next_line();
  /// Moves to the next line that has a word; false at the end.
  bool next_line_with_words();
  /// What is left of the current line, and of the whole text after it.
  [[nodiscard]] std::string_view rest_of_line() const { return line_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Shortens the current line, for readers whose format has comments.
  void set_rest_of_line(std::string_view line) { line_ = line; }

  /// The next word of the current line, empty at its end.
  std::string_view word();
  [[nodiscard]] bool at_end_of_line() const { return trimmed(line_).empty(); }

  /// The next word as a number; throws InputError naming `what` where it is missing or something else. finite_number()
  /// also refuses infinities and NaN.
  double number(std::string_view what);
  double finite_number(std::string_view what);
  std::int64_t integer(std::string_view what);
  /// A whole number that is not negative.
  std::uint64_t count(std::string_view what);

  /// Throws InputError with the place and this message.
  [[noreturn]] void fail(std::string_view message) const;

 private:
  std::string_view rest_;
  std::string_view line_;
  std::string name_;
  std::int64_t line_number_ = 0;
};

}  // namespace vantage
